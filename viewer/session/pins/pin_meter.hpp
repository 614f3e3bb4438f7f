#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pins/pin_values.hpp"
#include "supple/scene.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

/// What the user follows: an object, a pair of objects, or a contact of a pair.
struct Pin {
  std::uint32_t number = 0;         ///< chosen by the page
  std::vector<ObjectId> objects{};  ///< one, or two; twice the same for contacts of an object with itself
  std::vector<std::uint32_t>
      contact{};  ///< empty, or what touches, as a row of `contacts` or `impacts` starts
  /// Where the vertices of the object were at the start; only of one object.
  std::shared_ptr<const std::vector<Vec3d>> start{};
};

/// The values of a pin in a step.
struct PinRow {
  std::uint32_t pin = 0;  ///< its number
  std::uint64_t step = 0;
  double time = 0;
  PinValues values{};
};

/// The mean of the points that are finite; nothing when there are none.
std::optional<Vec3d> center_of(std::span<const Vec3d> points);

/// Measures pins after each step.
class PinMeter {
 public:
  /// Replaces the pins.
  void set(std::vector<Pin> pins);
  bool empty() const { return pins_.empty(); }
  /// Call when the next step does not follow the last one.
  void forget();
  /// Where an object was in a step: the mean of its finite vertices.
  struct Place {
    std::uint64_t step = 0;
    double time = 0;
    Vec3d center{};
  };
  /// The place of an object in the step before, from sources that can read it.
  using Earlier = std::function<std::optional<Place>(ObjectId)>;
  /// Adds a row for each pin. A step that was measured before is measured again.
  void measure(const Scene& scene, std::uint64_t step, double time, std::vector<PinRow>& rows,
               const Earlier& earlier = {});

 private:
  /// Where the object of a pin was in the last step, and in the one before.
  struct Path {
    std::optional<Place> before{}, now{};
  };

  std::vector<Pin> pins_;
  std::vector<Path> paths_;  // one per pin
};

}  // namespace supple::viewer
