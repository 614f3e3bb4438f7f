// Time and peak memory of searches that hostile or unusual input makes slow: objects that are far from each
// other, many triangles at one distance, depths, and exact checks. Each case runs in a process of its own.
//
//   supple_bounds           all cases
//   supple_bounds CASE ...  those whose names contain one of the words

#include <fmt/core.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/trigonometry.hpp"
#include "supple/verify.hpp"

namespace supple {
namespace {

/// A case prepares a scene and returns the search, which returns a number of results.
struct Case {
  std::string name;
  std::function<std::function<std::size_t()>()> prepare;
};

TriangleMesh moved(TriangleMesh mesh, const Vec3d& offset) {
  for (Vec3d& p : mesh.positions) p += offset;
  return mesh;
}

/// Triangles around the first vertex.
TriangleMesh make_fan(std::uint32_t count, const Vec3d& apex, double height) {
  TriangleMesh fan{"", {apex}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turns = static_cast<double>(i) / count;
    fan.positions.push_back(apex + Vec3d{cos_turns(turns), sin_turns(turns), height});
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % count});
  }
  return fan;
}

TriangleMesh equal_triangles(std::uint32_t count) {
  TriangleMesh mesh{"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
  mesh.triangles.assign(count, {0, 1, 2});
  return mesh;
}

/// A scene that the search keeps.
struct World {
  Scene scene;
  std::vector<ObjectId> ids;
};

std::function<std::size_t()> distance_of(const TriangleMesh& a, const TriangleMesh& b) {
  auto world = std::make_shared<World>(World{Scene({.threads = 1}), {}});
  world->ids = {world->scene.add(a), world->scene.add(b)};
  return [world] { return world->scene.distance(world->ids[0], world->ids[1]) ? 1u : 0u; };
}

std::function<std::size_t()> closest_of(const TriangleMesh& mesh, double far) {
  auto world = std::make_shared<World>(World{Scene({.threads = 1}), {}});
  world->ids = {world->scene.add(mesh)};
  return [world, far] {
    std::vector<Vec3d> points;
    for (int i = 0; i < 1000; ++i)
      points.push_back(far * Vec3d{cos_turns(i * 1e-3), sin_turns(i * 1e-3), 0.3});
    std::vector<std::optional<ClosestPoint>> results(points.size());
    world->scene.closest(points, results);
    return results.size();
  };
}

std::function<std::size_t()> rays_of(const TriangleMesh& mesh, double far) {
  auto world = std::make_shared<World>(World{Scene({.threads = 1}), {}});
  world->ids = {world->scene.add(mesh)};
  return [world, far] {
    std::vector<Ray> rays;
    for (int i = 0; i < 1000; ++i) {
      const Vec3d direction{cos_turns(i * 1e-3), sin_turns(i * 1e-3), 0.3};
      rays.push_back({far * direction, -direction});
    }
    std::vector<std::optional<RayHit>> results(rays.size());
    world->scene.cast(rays, results);
    return static_cast<std::size_t>(
        std::ranges::count_if(results, [](const auto& r) { return r.has_value(); }));
  };
}

std::function<std::size_t()> detect_of(const std::vector<TriangleMesh>& meshes, const ObjectOptions& object,
                                       SceneOptions options, const DetectRequest& request = {}) {
  options.threads = 1;
  auto world = std::make_shared<World>(World{Scene(options), {}});
  for (const TriangleMesh& mesh : meshes) world->ids.push_back(world->scene.add(mesh, object));
  return [world, request] {
    const DetectResult& result = world->scene.detect(request);
    return result.contacts.size() + result.continuous_contacts.size() + result.proximity_pairs.size();
  };
}

/// A triangle of which each vertex is on one of three short arcs, so that all triangles meet.
TriangleMesh triangles_that_all_meet(std::uint32_t count) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double turns = 0.3 * i / count, tilt = 0.1 * i / count;
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(
          {cos_turns(turns + k / 3.0), sin_turns(turns + k / 3.0), k == 0 ? tilt : -tilt});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Balls in a grid, each a little inside its neighbours.
std::vector<TriangleMesh> pile_of_balls() {
  std::vector<TriangleMesh> balls;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      for (int k = 0; k < 5; ++k)
        balls.push_back(
            moved(make_icosphere(8), {1.85 * i + 0.1 * (j % 2), 1.85 * j + 0.07 * k, 1.85 * k + 0.05 * i}));
    }
  }
  return balls;
}

/// A ball whose vertices are mostly deep inside a larger one.
std::vector<TriangleMesh> deep_balls() {
  TriangleMesh inner = make_icosphere(30);
  for (Vec3d& p : inner.positions) p = 0.7 * p;
  return {make_icosphere(40), moved(inner, {0.6, 0.1, 0.05})};
}

/// One more step of a solver: the vertices have moved a little.
std::function<std::size_t()> step_of(const std::vector<TriangleMesh>& meshes, ContactKinds kinds) {
  auto world = std::make_shared<World>(World{Scene({.contacts = kinds, .threads = 1}), {}});
  for (const TriangleMesh& mesh : meshes) world->ids.push_back(world->scene.add(mesh, {.solid = true}));
  world->scene.detect();
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    std::vector<Vec3d> positions = meshes[i].positions;
    for (Vec3d& p : positions)
      p += 0.002 * Vec3d{sin_turns(1.4 * p.y + 0.2 * static_cast<double>(i)), sin_turns(p.z), 0};
    world->scene.set_positions(world->ids[i], positions);
  }
  return [world] { return world->scene.detect().penetrations.size(); };
}

std::function<std::size_t()> verify_of(const std::vector<TriangleMesh>& meshes, ContactKinds kinds) {
  auto world = std::make_shared<World>(World{Scene({.contacts = kinds, .threads = 1}), {}});
  for (const TriangleMesh& mesh : meshes) world->ids.push_back(world->scene.add(mesh, {.solid = true}));
  world->scene.detect();
  return [world] { return static_cast<std::size_t>(verify(world->scene).inside_vertices); };
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const std::uint32_t frequency : {9u, 59u}) {
    const auto triangles = std::to_string(20 * frequency * frequency);
    for (const double ratio : {3.0, 1e3, 1e6, 1e9, 1e12, 1e15, 1e30}) {
      const std::string at = triangles + " triangles, ratio " + fmt::format("{:g}", ratio);
      const auto ball = [frequency] { return make_icosphere(frequency); };
      const Vec3d offset{ratio, 0.1, 0.2};
      cases.push_back(
          {"distance of balls of " + at, [=] { return distance_of(ball(), moved(ball(), offset)); }});
      if (frequency == 9) continue;
      cases.push_back({"1000 closest points on " + at, [=] { return closest_of(ball(), ratio); }});
      cases.push_back({"1000 rays at " + at, [=] { return rays_of(ball(), ratio); }});
    }
    for (const double offset : {1e3, 1e6, 1e9}) {
      const Vec3d far{offset, offset, -offset};
      cases.push_back(
          {"distance of balls of " + triangles + " triangles, gap 0.5, offset " + fmt::format("{:g}", offset),
           [=] {
             const TriangleMesh ball = make_icosphere(frequency);
             return distance_of(moved(ball, far), moved(ball, far + Vec3d{2.5, 0.1, 0.2}));
           }});
    }
  }
  for (const double ratio : {1.0, 1e6, 1e12}) {
    cases.push_back({"distance of plates of 20000 triangles, ratio " + fmt::format("{:g}", ratio), [=] {
                       const TriangleMesh plate = make_cloth(101, 101);
                       return distance_of(plate, moved(plate, {0, ratio, 0}));
                     }});
  }
  for (const std::uint32_t count : {1000u, 3000u}) {
    const std::string fans = "fans of " + std::to_string(count) + " triangles";
    const TriangleMesh low = make_fan(count, {0, 0, 0}, -2), high = make_fan(count, {0, 0, 1}, 2);
    cases.push_back({"distance of two " + fans, [=] { return distance_of(low, high); }});
    cases.push_back({"proximity of two " + fans, [=] {
                       return detect_of({low, high}, {.margin = 0.51}, {.contacts = ContactKinds::proximity});
                     }});
    cases.push_back({"first contacts of two " + fans, [=] {
                       SceneOptions options{.contacts = ContactKinds::continuous};
                       options.impact.min_separation = 1.02;
                       options.continuous_listing = ContinuousListing::first;
                       return detect_of({low, high}, {}, options);
                     }});
  }
  cases.push_back({"distance of 3000 equal triangles to 3000 others", [] {
                     return distance_of(equal_triangles(3000), moved(equal_triangles(3000), {0, 0, 1}));
                   }});
  cases.push_back({"self-collision of 30000 equal triangles",
                   [] { return detect_of({equal_triangles(30000)}, {.self_collision = true}, {}); }});
  cases.push_back({"1000 contacts of 2000 triangles that all meet", [] {
                     return detect_of({triangles_that_all_meet(2000)}, {.self_collision = true}, {},
                                      {.max_contacts = 1000});
                   }});
  for (const auto& [kind, kinds] :
       {std::pair{"penetration", ContactKinds::penetration}, {"intersections", ContactKinds::intersection}}) {
    cases.push_back({fmt::format("step of a pile of 125 balls, {}", kind),
                     [=] { return step_of(pile_of_balls(), kinds); }});
    cases.push_back(
        {fmt::format("step of deep balls, {}", kind), [=] { return step_of(deep_balls(), kinds); }});
  }
  cases.push_back({"verify of penetration of two balls of 69620 triangles", [] {
                     const TriangleMesh ball = make_icosphere(59);
                     return verify_of({ball, moved(ball, {0.5, 0.1, 0.2})}, ContactKinds::penetration);
                   }});
  return cases;
}

/// The least of some runs, or one run that takes long.
double best_seconds(const Case& chosen, std::size_t& results) {
  using Clock = std::chrono::steady_clock;
  double best = 1e300, total = 0;
  for (int i = 0; i < 5 && total < 2; ++i) {
    const auto run = chosen.prepare();
    const auto start = Clock::now();
    results = run();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, seconds);
    total += seconds;
  }
  return best;
}

void run_case(const Case& chosen, unsigned limit) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    alarm(limit);
    std::size_t results = 0;
    const double seconds = best_seconds(chosen, results);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    fmt::print("| {} | {} | {:.4g} | {} |\n", chosen.name, results, 1e3 * seconds, usage.ru_maxrss / 1024);
    std::fflush(stdout);
    _exit(0);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  if (status != 0)
    fmt::print("| {} | – | more than {} s | {} |\n", chosen.name, limit, usage.ru_maxrss / 1024);
}

int run(const std::vector<std::string>& words) {
  constexpr unsigned limit = 60;  // seconds
  fmt::print("| case | results | ms | peak MB |\n|---|---|---|---|\n");
  for (const Case& each : all_cases()) {
    const auto is_in_name = [&](const std::string& word) {
      return each.name.find(word) != std::string::npos;
    };
    if (words.empty() || std::ranges::any_of(words, is_in_name)) run_case(each, limit);
  }
  return 0;
}

}  // namespace
}  // namespace supple

int main(int count, char** arguments) {
  return supple::run({arguments + 1, arguments + count});
}
