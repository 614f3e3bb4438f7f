// The first impact of two moving elements against exact algebra, and their safe step against rational
// arithmetic.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "supple/continuous.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/kept_distance.hpp"

namespace {

using namespace supple;
using fuzz::check;

void check_impact(const Impact& impact, const TimeBracket& truth) {
  check(impact.certainty == ImpactCertainty::certain, "an exact impact is not certain");
  check(impact.toi <= truth.high, "the impact is later than the first contact");
  check(truth.low - impact.toi <= toi_tolerance_at(truth.high), "the impact is too early");
  check(impact.touching_at_start == (truth.high == 0), "it is wrong whether they touch at the start");
  check(std::isfinite(impact.point.x) && std::isfinite(impact.point.y) && std::isfinite(impact.point.z),
        "the point is not finite");
  for (const double weight : impact.barycentric)
    check(weight >= 0 && weight <= 1, "a weight is not from 0 to 1");
  const Vec3d n = impact.normal;
  const double square = n.x * n.x + n.y * n.y + n.z * n.z;
  check(square == 0 || std::abs(square - 1) < 1e-12, "the normal is not a unit vector");
}

template <class Motion>
void run(fuzz::ByteReader& bytes) {
  fuzz::CoordinateReader coordinate(bytes);
  Motion motion;
  for (Vec3d& point : motion.start) point = coordinate.point();
  const std::uint8_t still = bytes.byte();  // bits of the vertices that rest
  for (std::size_t i = 0; i < motion.end.size(); ++i)
    motion.end[i] = (still >> i & 0x11) == 1 ? motion.start[i] : coordinate.point();
  ImpactOptions options;
  if (bytes.below(4) == 0) options.min_separation = std::abs(coordinate());
  if (!std::isfinite(options.min_separation)) options.min_separation = 0;
  if (bytes.below(4) == 0) options.max_time = static_cast<double>(bytes.byte()) / 255;

  const auto found = first_impact(motion, options);
  ImpactOptions quick = options;
  quick.exact = false;
  const auto by_filters = first_impact(motion, quick);
  check(by_filters || !found, "filters lose an impact");
  check(!by_filters || found || by_filters->certainty == ImpactCertainty::within_tolerance,
        "filters call a wrong impact certain");
  if (!coordinate.is_quick()) return;
  const auto truth = first_contact_by_algebra(motion, options.min_separation);
  if (found) {
    check(truth.has_value(), "the elements stay apart");
    check_impact(*found, *truth);
    check(found->toi <= options.max_time, "the impact is later than the largest time");
  } else if (truth) {
    // The reported time is never later than the true one.
    check(truth->high > options.max_time, "the impact is missed");
  }
}

/// Two objects of one element each.
void run_safe_step(fuzz::ByteReader& bytes) {
  fuzz::CoordinateReader coordinate(bytes);
  const std::uint32_t kind = bytes.below(5);
  const std::size_t count_a = kind < 2 ? 2 : 1, count_b = kind < 2 ? 2 : kind < 4 ? 3 : 1;
  truth::TwoElements elements;
  const std::uint8_t still = bytes.byte();  // bits of the vertices that rest
  const bool is_rigid = bytes.below(4) == 0;
  double size = 0;
  const auto place = [&] {
    const Vec3d p = coordinate.point();
    for (int axis = 0; axis < 3; ++axis) size = std::max(size, std::abs(p[axis]));
    return p;
  };
  const auto add = [&](std::size_t count, unsigned bits, std::vector<Vec3d>& start, std::vector<Vec3d>& end) {
    const Vec3d way = place();
    for (std::size_t i = 0; i < count; ++i) {
      start.push_back(place());
      const bool rests = (bits >> i & 1) != 0;
      end.push_back(is_rigid ? start[i] + way : rests ? start[i] : place());
    }
  };
  add(count_a, still, elements.start_a, elements.end_a);
  add(count_b, still >> 4u, elements.start_b, elements.end_b);
  const double keep = static_cast<double>(bytes.below(100)) / 100;
  double separation = bytes.below(2) == 0 ? std::abs(coordinate()) : 0;
  if (bytes.below(4) == 0) separation *= static_cast<double>(bytes.byte()) / 255;
  if (!coordinate.is_small() || !(size < 0x1p20)) return;
  const std::vector<truth::MovingPair> pairs = elements.pairs();
  const SafeStep found = elements.scene(separation).collision_free_step({.keep = keep});
  check(found.limit.has_value() == (found.step < 1), "a step has no limit");
  if (touch_at_start(pairs)) return;
  const truth::StepFault fault = check_step(pairs, separation, keep, found.step, bytes.below(8) == 0);
  check(fault != truth::StepFault::too_long, "the safe step is too long");
  // Where elements are so near that rounding could make them touch, the step is shorter.
  const bool is_near = std::ranges::any_of(pairs, [&](const truth::MovingPair& pair) {
    return truth::KeptSquare(pair, separation, keep).rounded() <= 0x1p-44 * size;
  });
  check(is_near || fault == truth::StepFault::none, "the safe step is too short");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteReader bytes(data, size);
  switch (bytes.below(8)) {
    case 0:
      run<PointPointMotion>(bytes);
      break;
    case 1:
      run<PointEdgeMotion>(bytes);
      break;
    case 2:
    case 3:
    case 4:
      run<VertexFaceMotion>(bytes);
      break;
    default:
      run<EdgeEdgeMotion>(bytes);
  }
  if (!bytes.at_end()) run_safe_step(bytes);
  return 0;
}
