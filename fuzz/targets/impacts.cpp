// The first impact of two moving elements against exact algebra.

#include <algorithm>
#include <array>
#include <cmath>

#include "supple/continuous.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"

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
  return 0;
}
