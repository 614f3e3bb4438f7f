#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
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

/// An object, its start position, and its motion: none, waves, masses and springs, or rigid.
struct ViewedObject {
  TriangleMesh mesh;
  ObjectOptions options{};
  std::variant<std::monostate, WaveMotion, MassSpringMotion, RigidMotion> motion{};
  /// In the scene of a program; without an id, the object was removed.
  std::optional<ObjectId> id{};
  std::uint64_t mesh_version = 0;
};

/// Time series of a recording: rows of numbers, and begin and end events of pairs.
struct Series {
  struct Event {
    std::uint32_t frame = 0, a = 0, b = 0;  ///< object ids, a < b
    constexpr bool operator==(const Event&) const = default;
  };
  struct Events {
    std::vector<Event> begin{}, end{};
  };
  std::vector<std::string> names{};  ///< of the columns; the first is "time"
  std::vector<double> values{};      ///< row by row, one row per frame
  Events contacts{};
  Events narrow_phase{};  ///< only when the recording has colliding vertices
  Events volumes{};
};

/// The frames of a recording, or of a sequence of files with one frame each.
class Frames {
 public:
  virtual ~Frames() = default;
  virtual std::uint64_t count() const = 0;
  /// Reads the positions of one object. Throws `Error` when the frame cannot be read.
  virtual void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const = 0;
  /// May have no rows; the page then plots the frames it has received.
  virtual const Series& series() const = 0;

  /// The number of the step that a frame shows.
  virtual std::uint64_t step(std::uint64_t frame) const { return frame; }
  /// The last frame not after a step; 0 when there is none.
  virtual std::uint64_t frame_of(std::uint64_t step) const { return step; }
  /// Whether a frame shows the step after that of the frame before, so that continuous contacts between the
  /// two can be found.
  virtual bool follows(std::uint64_t frame) const { return frame > 0; }
  /// Whether frames are still being added.
  virtual bool is_growing() const { return false; }
  /// Looks for frames that were added since the last call; returns whether there are any. Throws `Error` when
  /// they do not continue these frames.
  virtual bool refresh() { return false; }
};

/// Two recordings that are shown together. Objects of different recordings are not tested with each other.
struct Comparison {
  std::array<std::string, 2> names{};
  std::size_t objects_of_a = 0;          ///< the first objects are those of the first recording
  std::optional<std::uint64_t> frame{};  ///< the first one that differs; none when only the headers differ
  std::string text{};                    ///< what differs first; empty when nothing does
};

class Program;

/// Everything a session shows: objects that a simulation moves, that were recorded, or that a program moves.
struct SceneView {
  std::string title{};
  SimulationOptions simulation{};
  std::vector<ViewedObject> objects{};
  std::shared_ptr<Frames> frames{};        ///< only of a recording
  std::shared_ptr<Program> program{};      ///< only of a running program
  std::optional<Comparison> comparison{};  ///< only of two recordings
};

}  // namespace supple::viewer
