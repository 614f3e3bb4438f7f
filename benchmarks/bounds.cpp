// Time and peak memory of searches that hostile or unusual input makes slow: objects that are far from each
// other, and many triangles at one distance. Each case runs in a process of its own.
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
                                       SceneOptions options) {
  options.threads = 1;
  auto world = std::make_shared<World>(World{Scene(options), {}});
  for (const TriangleMesh& mesh : meshes) world->ids.push_back(world->scene.add(mesh, object));
  return [world] {
    const DetectResult& result = world->scene.detect();
    return result.contacts.size() + result.continuous_contacts.size() + result.proximity_pairs.size();
  };
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
