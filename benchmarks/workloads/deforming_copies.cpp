#include "workloads/deforming_copies.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/trigonometry.hpp"
#include "workloads/random_numbers.hpp"
#include "workloads/shared_data.hpp"

namespace supple::benchmarks {
namespace {

constexpr double turns_of_radian = 0.15915494309189533577;

/// The rows of a uniformly distributed rotation: a unit quaternion from a point in the four-dimensional
/// ball.
std::array<Vec3d, 3> random_rotation(RandomNumbers& random) {
  double w = 0, x = 0, y = 0, z = 0, squared = 0;
  do {
    w = random.uniform(-1, 1);
    x = random.uniform(-1, 1);
    y = random.uniform(-1, 1);
    z = random.uniform(-1, 1);
    squared = w * w + x * x + y * y + z * z;
  } while (squared > 1 || squared < 0x1p-20);
  const double s = 2 / squared;
  return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
           {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
           {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}

Vec3f rounded(Vec3d p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Centres the mesh on the origin and scales its longest half extent to 1.
void normalize(TriangleMesh& mesh) {
  Vec3d low = mesh.positions.front(), high = low;
  for (const Vec3d& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const Vec3d extent = high - low;
  const double scale = 2 / std::max({extent.x, extent.y, extent.z});
  for (Vec3d& p : mesh.positions) p = (p - (low + high) * 0.5) * scale;
}

}  // namespace

DeformingCopies::DeformingCopies(TriangleMesh mesh, std::size_t copies, double spacing, std::size_t one_in,
                                 std::uint64_t seed)
    : mesh_(std::move(mesh)), one_in_(one_in), copies_(copies) {
  RandomNumbers random(seed);
  std::size_t side = 1;
  while (side * side * side < copies) ++side;
  for (std::size_t i = 0; i < copies; ++i) {
    Copy& copy = copies_[i];
    copy.center = Vec3d{static_cast<double>(i % side), static_cast<double>(i / side % side),
                        static_cast<double>(i / side / side)} *
                  spacing;
    copy.phase = random.uniform();
    const auto rotation = random_rotation(random);
    for (const Vec3d& p : mesh_.positions) {
      copy.rest.push_back(rounded({dot(rotation[0], p), dot(rotation[1], p), dot(rotation[2], p)}));
    }
    copy.positions.resize(copy.rest.size() + 1);
    deform(copy);
  }
}

void DeformingCopies::deform(Copy& copy) const {
  const double slow = time_ * turns_of_radian + copy.phase, fast = 1.7 * time_ * turns_of_radian + copy.phase;
  const double shift = 0.03 * sin_turns(slow);
  const Vec3d center = copy.center + Vec3d{shift, shift, shift};
  copy.bounds = {};
  for (std::size_t i = 0; i < copy.rest.size(); ++i) {
    const Vec3d b{copy.rest[i].x, copy.rest[i].y, copy.rest[i].z};
    const double wide = sin_turns((3 * b.x + 4 * b.y) * turns_of_radian + slow);
    const double narrow = sin_turns((9 * b.z - 7 * b.x) * turns_of_radian + fast);
    const Vec3f p = rounded(center + b * (1 + 0.04 * wide + 0.015 * narrow));
    for (int axis = 0; axis < 3; ++axis) {
      copy.bounds.min[axis] = std::min(copy.bounds.min[axis], p[axis]);
      copy.bounds.max[axis] = std::max(copy.bounds.max[axis], p[axis]);
    }
    copy.positions[i] = p;
  }
}

void DeformingCopies::advance() {
  time_ += 0.1;
  for (std::size_t i = 0; i < copies_.size(); ++i) {
    if (moves(i)) deform(copies_[i]);
  }
}

std::optional<DeformingCopies> make_deforming_copies(const std::string& name) {
  static const std::regex form("(bunny|[1-9][0-9]{1,7})x([1-9][0-9]{0,4})(-rest)?");
  std::smatch parts;
  const bool matches = std::regex_match(name, parts, form);
  const std::string shape = matches ? parts[1].str() : "0";
  std::uint32_t frequency = 1;
  while (shape != "bunny" && 20 * frequency * frequency < std::stoul(shape)) ++frequency;
  if (!matches || (shape != "bunny" && 20 * frequency * frequency != std::stoul(shape)))
    throw Error(
        "no deforming copies are named '" + name +
        "'; write SHAPExCOPIES, SHAPE being bunny or a number of triangles that is 20 times a square, "
        "such as 18000x64, and -rest when most are at rest");
  const std::size_t copies = std::stoul(parts[2].str()), one_in = parts[3].matched ? 10 : 1;
  if (shape != "bunny") return DeformingCopies(make_icosphere(frequency), copies, 1.9, one_in);
  auto bunny = load_shared("models/stanford-bunny.obj");
  if (!bunny) return std::nullopt;
  normalize(*bunny);
  return DeformingCopies(*std::move(bunny), copies, 1.5, one_in);
}

}  // namespace supple::benchmarks
