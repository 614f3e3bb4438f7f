#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "supple/scene.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

/// Where the objects of a show are, and what touches there. Objects are named by their place in the show.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  /// In which everything was detected where it is. Objects have the index that is their place.
  virtual const Scene& scene() const = 0;
  virtual ObjectId id(std::size_t object) const = 0;
  virtual std::span<const Vec3d> positions(std::size_t object) const = 0;
  /// Another number each time the object moves.
  virtual std::uint64_t version(std::size_t object) const = 0;
  /// Steps taken, or the number of the frame.
  virtual std::uint64_t step() const = 0;
  virtual double time() const = 0;
  /// What moving everything took, or reading it.
  virtual double motion_seconds() const = 0;
};

}  // namespace supple::viewer
