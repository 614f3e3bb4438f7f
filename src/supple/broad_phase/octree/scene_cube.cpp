#include "broad_phase/octree/scene_cube.hpp"

#include <algorithm>
#include <cmath>

namespace supple {
namespace {

constexpr std::size_t sample_size = 4096;
/// The edge of the cube relative to the core, so that objects can move before they leave the cube.
constexpr double margin = 1.1;
/// Coordinates are clamped to this range, so that edges and sums of coordinates stay finite.
constexpr double farthest = 1e37;

/// The next larger number of six significant bits. Its halves lose few digits when added to a coordinate.
float round_to_few_bits(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return static_cast<float>(std::ldexp(std::ceil(fraction * 64), exponent - 6));
}

double largest_coordinate(const Vec3f& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// Planes that are closer than eight floats might round to the same float and divide nothing.
float finest_edge_of(const SceneCube& cube) {
  return static_cast<float>((largest_coordinate(cube.center) + 0.5 * cube.edge) * 0x1p-20);
}

SceneCube cube_of(const RootCube& root) {
  SceneCube cube;
  for (int axis = 0; axis < 3; ++axis)
    cube.center[axis] = static_cast<float>(root.corner[axis] + 0.5 * root.edge);
  cube.edge = static_cast<float>(root.edge);
  cube.finest_edge = finest_edge_of(cube);
  return cube;
}

}  // namespace

bool is_outdated(const SceneCube& present, const SceneCube& best) {
  const double half = 0.5 * double{present.edge};
  for (int axis = 0; axis < 3; ++axis)
    if (best.core.min[axis] < present.center[axis] - half ||
        best.core.max[axis] > present.center[axis] + half)
      return true;
  return best.edge < half;
}

SceneCube SceneCubeChooser::choose(std::span<const Aabb> boxes) {
  if (given_) return cube_of(*given_);
  centers_.clear();
  std::vector<float>& extents = scratch_;
  extents.clear();
  // Counting the objects first keeps the sample large when most slots are empty.
  const auto live = static_cast<std::size_t>(
      std::count_if(boxes.begin(), boxes.end(), [](const Aabb& box) { return !box.empty(); }));
  const std::size_t stride = (live + sample_size - 1) / sample_size;
  std::size_t seen = 0;
  for (const Aabb& box : boxes) {
    if (box.empty() || seen++ % stride != 0) continue;
    Vec3f center;
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = 0.5 * (double{box.min[axis]} + box.max[axis]);
      center[axis] = static_cast<float>(std::clamp(middle, -farthest, farthest));
      extent = std::max(extent, double{box.max[axis]} - box.min[axis]);
    }
    if (!std::isfinite(extent) || std::isnan(center.x + center.y + center.z)) continue;
    centers_.push_back(center);
    extents.push_back(static_cast<float>(std::min(extent, farthest)));
  }

  SceneCube cube;
  if (centers_.empty()) return cube;
  const std::size_t middle = extents.size() / 2;
  std::nth_element(extents.begin(), extents.begin() + static_cast<std::ptrdiff_t>(middle), extents.end());
  const float median_extent = extents[middle];

  double edge = 0;
  for (int axis = 0; axis < 3; ++axis) {
    scratch_.clear();
    for (const Vec3f& center : centers_) scratch_.push_back(center[axis]);
    std::sort(scratch_.begin(), scratch_.end());
    const std::size_t outermost = scratch_.size() / 64;
    cube.core.min[axis] = scratch_[outermost];
    cube.core.max[axis] = scratch_[scratch_.size() - 1 - outermost];
    cube.center[axis] = static_cast<float>(0.5 * (double{cube.core.min[axis]} + cube.core.max[axis]));
    edge = std::max(edge, double{cube.core.max[axis]} - cube.core.min[axis]);
  }
  edge = margin * edge + median_extent;
  cube.edge = round_to_few_bits(std::max({edge, largest_coordinate(cube.center) * 0x1p-18, 1e-30}));
  cube.finest_edge = finest_edge_of(cube);
  return cube;
}

}  // namespace supple
