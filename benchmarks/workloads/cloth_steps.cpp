#include "workloads/cloth_steps.hpp"

#include <utility>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/trigonometry.hpp"
#include "workloads/shared_data.hpp"

namespace supple::benchmarks {
namespace {

std::optional<ClothStep> load_step(const std::string& first, const std::string& second) {
  auto start = load_shared("scalable-ccd/" + first), end = load_shared("scalable-ccd/" + second);
  if (!start || !end) return std::nullopt;
  return ClothStep{std::move(start->positions), std::move(end->positions), std::move(start->triangles)};
}

/// Rounds as in the real frames, so that boxes in single precision equal boxes in double precision.
Vec3d in_single(Vec3d p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// A sheet compressed to a third of its width, so that it lies in folds, and dented along the other axis.
ClothStep crumpled(std::uint32_t columns, std::uint32_t rows) {
  const TriangleMesh sheet = make_cloth(columns, rows, 2, 1);
  ClothStep step{{}, {}, sheet.triangles};
  for (const Vec3d& p : sheet.positions) {
    const double fold = sin_turns(3 * p.x + 0.1 * p.z), dent = sin_turns(2.5 * p.z + 0.2 + 0.3 * p.x);
    const double ripple = sin_turns(7.3 * p.x + 5.9 * p.z), bend = 0.015 * sin_turns(1.7 * p.x + 2.3 * p.z);
    const double x = 0.33 * p.x + 0.08 * fold, y = 0.12 * fold * dent + 0.004 * ripple;
    step.start.push_back(in_single({x + bend, y, p.z + 0.01 * dent}));
    step.end.push_back(in_single({x - bend + 0.004 * fold, y + 0.01 * p.z, p.z + 0.012 * dent}));
  }
  return step;
}

}  // namespace

std::optional<ClothStep> make_cloth_step(const std::string& name) {
  if (name == "cloth-ball")
    return load_step("cloth-ball/frames/cloth_ball92.ply", "cloth-ball/frames/cloth_ball93.ply");
  if (name == "cloth-funnel") return load_step("cloth-funnel/frames/227.ply", "cloth-funnel/frames/228.ply");
  if (name == "crumpled") return crumpled(300, 150);
  if (name == "crumpled-small") return crumpled(48, 24);
  throw Error("no cloth is named '" + name +
              "'; choose one of cloth-ball, cloth-funnel, crumpled, crumpled-small");
}

}  // namespace supple::benchmarks
