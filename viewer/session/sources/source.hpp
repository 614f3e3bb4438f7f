#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "supple/scene.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

class JsonText;
struct Center;

/// Positions and contacts of the objects of a scene view. Objects are named by their index in it.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  /// The scene of the last detection. Object indices equal those of the scene view.
  virtual const Scene& scene() const = 0;
  /// The kinds of contacts that were detected.
  virtual ContactKinds contacts() const { return scene().options().contacts; }
  virtual ObjectId id(std::size_t object) const = 0;
  virtual std::span<const Vec3d> positions(std::size_t object) const = 0;
  /// Changes each time the object moves.
  virtual std::uint64_t version(std::size_t object) const = 0;
  /// Number of steps taken, or the frame number.
  virtual std::uint64_t step() const = 0;
  virtual double time() const = 0;
  /// Time spent moving objects, or reading their positions.
  virtual double motion_seconds() const = 0;
  /// Adds members to the text of a frame.
  virtual void add_to(JsonText&, const Center&) const {}
};

}  // namespace supple::viewer
