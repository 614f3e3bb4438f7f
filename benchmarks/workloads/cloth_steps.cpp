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

/// Adds a copy of a body; `start` and `end` place its vertices.
template <class Start, class End>
void add_body(ClothStep& step, const TriangleMesh& body, Start start, End end) {
  const auto first = static_cast<std::uint32_t>(step.start.size());
  for (const Vec3d& p : body.positions) {
    step.start.push_back(in_single(start(p)));
    step.end.push_back(in_single(end(p)));
  }
  for (const Triangle& t : body.triangles)
    step.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// Layers of spheres of 980 triangles. Neighbouring layers fly in opposite directions, three diameters far,
/// and pass at a hundredth of a diameter.
ClothStep passing() {
  const TriangleMesh sphere = make_icosphere(7);
  ClothStep step;
  for (int i = 0; i < 64; ++i) {
    const int layer = i / 16;
    const Vec3d center{2.2 * (i % 4), 2.2 * (i / 4 % 4), 2.02 * layer};
    const double way = layer % 2 == 0 ? 3 : -3;
    add_body(
        step, sphere,
        [&](const Vec3d& p) {
          return center + p + Vec3d{-way, 0, 0};
        },
        [&](const Vec3d& p) {
          return center + p + Vec3d{way, 0.05, 0};
        });
  }
  return step;
}

/// Rods of length 2 and width 0.01 side by side, apart at the start. Each turns about its middle in another
/// direction, so that long triangles sweep over their neighbours and some touch.
ClothStep rods() {
  const TriangleMesh rod = make_box({2, 0.01, 0.01}, 1);
  ClothStep step;
  for (int i = 0; i < 400; ++i) {
    const Vec3d center{0, 0.02 * (i % 20), 0.02 * (i / 20)};
    const auto tilted = [&](const Vec3d& p, double by_y, double by_z) {
      const double y = p.y + by_y * p.x, z = p.z + by_z * p.x;
      return center + Vec3d{p.x - by_y * p.y - by_z * p.z, y + 0.1 * sin_turns(0.29 * i) * z, z};
    };
    const auto angle = [&](double turns) { return 0.004 * sin_turns(turns * i); };
    add_body(
        step, rod, [&](const Vec3d& p) { return tilted(p, angle(0.37), angle(0.61)); },
        [&](const Vec3d& p) { return tilted(p, 2 * angle(0.73), 2 * angle(0.17)); });
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
  if (name == "passing") return passing();
  if (name == "rods") return rods();
  throw Error("no cloth is named '" + name +
              "'; choose one of cloth-ball, cloth-funnel, crumpled, crumpled-small, passing, rods");
}

}  // namespace supple::benchmarks
