#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/simulation.hpp"
#include "supple/types.hpp"
#include "supple/wave_motion.hpp"

namespace supple::viewer {

/// An object of a show, where it is at the start, and what moves it: nothing, waves, or masses and springs.
struct ViewedObject {
  TriangleMesh mesh;
  ObjectOptions options{};
  std::variant<std::monostate, WaveMotion, MassSpringMotion> motion{};
};

/// What a recording says of its frames besides positions: rows of numbers, and pairs that begin and end.
struct Series {
  struct Event {
    std::uint32_t frame = 0, a = 0, b = 0;  ///< objects by their place in the show, a < b
    constexpr bool operator==(const Event&) const = default;
  };
  std::vector<std::string> names{};  ///< of the columns; the first one is "time"
  std::vector<double> values{};      ///< row by row, a row a frame
  std::vector<Event> begin{}, end{};
};

/// The frames of a recording, or of files that are a frame each.
class Frames {
 public:
  virtual ~Frames() = default;
  virtual std::uint64_t count() const = 0;
  /// Of one object, by its place in the show. Throws `Error` when the frame cannot be read.
  virtual void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const = 0;
  /// May be without rows: the page then plots what it has seen.
  virtual const Series& series() const = 0;
};

/// What there is to see: objects that move by themselves, or that were recorded.
struct SceneView {
  std::string title{};
  SimulationOptions simulation{};
  std::vector<ViewedObject> objects{};
  std::shared_ptr<const Frames> frames{};  ///< null of a simulation
};

}  // namespace supple::viewer
