// The time of searches for steps against that of `detect` for the same step, for steps that get longer and
// longer, as those of a solver that blows up. One thread; each line is one run of each.
//
//   supple_wild_steps [longest]    lines with steps longer than `longest` (default 1e4) have no `detect`

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace {

using namespace supple;

struct Body {
  TriangleMesh mesh;
  std::vector<Vec3d> ways;
};

class Ways {
 public:
  double number() { return 2 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1; }
  /// All vertices fly apart, around a common way.
  Body body(TriangleMesh mesh, Vec3d common, double apart) {
    Body body{std::move(mesh), {}};
    for (std::size_t v = 0; v < body.mesh.positions.size(); ++v)
      body.ways.push_back(common + apart * Vec3d{number(), number(), number()});
    return body;
  }

 private:
  std::mt19937_64 engine_{1};
};

TriangleMesh at(TriangleMesh mesh, Vec3d place) {
  for (Vec3d& p : mesh.positions) p += place;
  return mesh;
}

template <class Call>
double seconds_of(const Call& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(const std::string& name, const std::vector<Body>& bodies, double length, bool with_detect) {
  Scene scene({.contacts = ContactKinds::continuous, .threads = 1});
  for (const Body& body : bodies) {
    std::vector<Vec3d> to = body.mesh.positions;
    for (std::size_t v = 0; v < to.size(); ++v) to[v] += length * body.ways[v];
    scene.set_motion(scene.add(body.mesh, {.self_collision = true}), body.mesh.positions, to);
  }
  scene.earliest_impact();  // makes the octrees
  SafeStep longest, free;
  const double of_longest = seconds_of([&] { longest = scene.max_step(); }),
               of_free = seconds_of([&] { free = scene.collision_free_step(); }),
               of_objects = seconds_of([&] { scene.collision_free_steps(); });
  std::printf("| %s | %.0e | %.4g | %.4g | %.3g | %.3g | %.3g |", name.c_str(), length, longest.step,
              free.step, 1e3 * of_longest, 1e3 * of_free, 1e3 * of_objects);
  if (with_detect) {
    const double of_detect = seconds_of([&] { scene.detect(); });
    std::printf(" %.3g | %.2f | %.2f | %.2f |", 1e3 * of_detect, of_longest / of_detect, of_free / of_detect,
                of_objects / of_detect);
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  const double longest = count > 1 ? std::atof(arguments[1]) : 1e4;
  std::printf(
      "| scene | length | max_step | collision_free_step | ms | ms | ms of collision_free_steps | "
      "ms of detect | ratio of max_step | of collision_free_step | of collision_free_steps |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  Ways ways;
  for (const std::uint32_t resolution : {4u, 8u}) {
    const TriangleMesh beam = make_box({4, 0.5, 0.5}, resolution);
    const std::vector<Body> beams{ways.body(beam, {}, 1), ways.body(at(beam, {0, 0.6, 0}), {}, 1)};
    const std::string name = "two beams, " + std::to_string(2 * beam.triangles.size()) + " triangles";
    for (const double length : {1e-3, 1e-2, 1.0, 1e1, 1e2, 1e3, 1e6, 1e9, 1e30})
      measure(name, beams, length, length <= longest);
  }
  const std::vector<Body> cloth{ways.body(make_cloth(32, 32), {}, 1)};
  for (const double length : {1e-5, 1e-3, 1e-2, 1e-1, 1.0, 1e3, 1e9, 1e30})
    measure("exploding cloth, 2,048 triangles", cloth, length, length <= longest);
  std::vector<Body> deep;
  for (int i = 0; i < 4; ++i)
    deep.push_back(ways.body(at(make_icosphere(16), {0.1 * i, 0.05 * i, 0.02 * i}),
                             {0.3 * i - 0.5, 0.2, -0.1 * i}, 0.01));
  for (const double length : {1e-2, 1e-1, 1.0, 1e3, 1e9})
    measure("four deep bodies, " + std::to_string(4 * deep[0].mesh.triangles.size()) + " triangles", deep,
            length, length <= longest / 1e4);
  const TriangleMesh box = make_box({1, 1, 1}, 16);
  for (const Vec3d& way : {Vec3d{0.25, 0, 0.5}, Vec3d{0.25, 0.125, 0}, Vec3d{0.25, 0, -0.5}}) {
    const std::vector<Body> flush{ways.body(box, {}, 0), ways.body(at(box, {0, 0, 1}), way, 0)};
    const std::string name = way.z > 0 ? "part" : way.z < 0 ? "press" : "slide";
    for (const double length : {1e-3, 1.0}) measure("flush boxes that " + name, flush, length, true);
  }
}
