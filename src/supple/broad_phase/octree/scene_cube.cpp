#include "broad_phase/octree/scene_cube.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace supple {
namespace {

constexpr std::size_t kSampleSize = 4096;
/// Room for objects to move before they leave the cube, relative to the spread of their centres.
constexpr double kMargin = 1.1;
/// Beyond this, edges and sums of coordinates would leave the range of float.
constexpr float kFarthest = 1e37f;
/// Up to this many objects the regions divide until objects are alone, as in the paper; it costs
/// microseconds.
constexpr std::size_t kFewObjects = 64;
/// More than this many objects in a leaf take longer to test against one another than to divide.
constexpr double kGoodLeaf = 64;

/// Bit i of the argument goes to bit 3i.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

constexpr std::uint32_t kCellLevels = 20;

/// Which of 2^20 parts of [low, low + edge) holds the value; the outer ones take what lies beyond.
std::uint64_t cell_along_axis(double value, double low, double edge) {
  constexpr double kCells = 1u << kCellLevels;
  const double cell = (value - low) / edge * kCells;
  return static_cast<std::uint64_t>(std::clamp(cell, 0.0, kCells - 1));
}

/// The next larger number of six significant bits: halves of it lose few digits when added to a coordinate.
float round_to_few_bits(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return static_cast<float>(std::ldexp(std::ceil(fraction * 64), exponent - 6));
}

}  // namespace

bool is_outdated(const SceneCube& present, const SceneCube& best) {
  const double half = 0.5 * double{present.edge};
  for (int axis = 0; axis < 3; ++axis)
    if (best.core.min[axis] < present.center[axis] - half ||
        best.core.max[axis] > present.center[axis] + half)
      return true;
  const double present_leaf = std::ldexp(present.edge, -static_cast<int>(present.max_level));
  const double best_leaf = std::ldexp(best.edge, -static_cast<int>(best.max_level));
  return best.edge < half || present_leaf > 2 * best_leaf || best_leaf > 2 * present_leaf;
}

SceneCube SceneCubeChooser::choose(std::span<const Aabb> boxes, std::uint32_t max_level) {
  centers_.clear();
  std::vector<float>& extents = scratch_;
  extents.clear();
  // Counted first, so that gaps left by removed objects do not thin the sample out.
  std::size_t live = 0;
  for (const Aabb& box : boxes) live += !box.empty();
  std::size_t seen = 0;
  for (const Aabb& box : boxes) {
    if (box.empty()) continue;
    const std::size_t place = seen * kSampleSize / std::max(live, kSampleSize);
    const bool taken =
        seen == 0 || live <= kSampleSize || place != (seen - 1) * kSampleSize / std::max(live, kSampleSize);
    ++seen;
    if (!taken) continue;
    Vec3f center;
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
      center[axis] = static_cast<float>(
          std::clamp(0.5 * (double{box.min[axis]} + box.max[axis]), -double{kFarthest}, double{kFarthest}));
      extent = std::max(extent, double{box.max[axis]} - box.min[axis]);
    }
    if (!std::isfinite(extent) || std::isnan(center.x + center.y + center.z)) continue;
    centers_.push_back(center);
    extents.push_back(static_cast<float>(std::min(extent, double{kFarthest})));
  }

  SceneCube cube;
  cube.max_level = max_level == 0 ? 1 : max_level;
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
  edge = kMargin * edge + median_extent;
  const double distance =
      std::max({std::fabs(cube.center.x), std::fabs(cube.center.y), std::fabs(cube.center.z)});
  cube.edge = round_to_few_bits(std::max({edge, distance * 0x1p-18, 1e-30}));
  if (max_level == 0) cube.max_level = automatic_level(cube, live, median_extent);
  // Planes closer than eight floats might be rounded onto one another, and would no longer divide anything.
  const double finest_edge = (distance + 0.5 * cube.edge) * 0x1p-20;
  while (cube.max_level > 1 && std::ldexp(cube.edge, -static_cast<int>(cube.max_level)) < finest_edge)
    --cube.max_level;
  return cube;
}

std::uint32_t SceneCubeChooser::automatic_level(const SceneCube& cube, std::size_t object_count,
                                                float median_extent) {
  std::uint32_t deepest = 1;
  while (deepest < kCellLevels &&
         cube.edge * std::ldexp(1.0, -static_cast<int>(deepest + 1)) >= median_extent)
    ++deepest;

  cells_.clear();
  for (const Vec3f& center : centers_) {
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = cube.center[axis] - 0.5 * cube.edge;
      cell |= spread_bits(cell_along_axis(center[axis], low, cube.edge)) << axis;
    }
    cells_.push_back(cell);
  }
  std::sort(cells_.begin(), cells_.end());

  // Objects that share a leaf with an average object, by level, scaled up from the sample. A crowd that no
  // level parts counts no more than so many, lest it hide what the others gain.
  constexpr double kCrowd = 512;
  std::array<double, kCellLevels + 1> company{};
  const double sampled = static_cast<double>(centers_.size());
  const double scale = sampled < 2 ? 0 : static_cast<double>(object_count - 1) / (sampled - 1);
  for (std::uint32_t level = 1; level <= deepest; ++level) {
    const std::uint32_t shift = 3 * (kCellLevels - level);
    std::size_t run_begin = 0;
    for (std::size_t i = 1; i <= cells_.size(); ++i) {
      if (i != cells_.size() && cells_[i] >> shift == cells_[run_begin] >> shift) continue;
      const double run = static_cast<double>(i - run_begin);
      company[level] += run / sampled * std::min((run - 1) * scale, kCrowd);
      run_begin = i;
    }
  }
  // Going deeper is in vain where objects coincide: the first level that does about as well as the last will
  // do.
  constexpr double kAboutAsGood = 1.1;
  const double good =
      std::max(object_count <= kFewObjects ? 0.5 : kGoodLeaf, kAboutAsGood * company[deepest]);
  for (std::uint32_t level = 1; level < deepest; ++level)
    if (company[level] <= good) return level;
  return deepest;
}

}  // namespace supple
