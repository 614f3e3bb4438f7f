// Steps of mass-spring bodies. One item is one spring on an edge, so the inverse of items per second is the
// time per spring.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "supple/models.hpp"
#include "supple/motion.hpp"
#include "supple/supple.hpp"

namespace {

using namespace supple;

/// A sheet that is stretched, so that all springs are under tension, and moves as a whole.
void time_steps(benchmark::State& state, const TriangleMesh& mesh, const MassSpringOptions& options,
                double seconds) {
  MassSpringBody body(mesh, options);
  std::vector<Vec3d> positions = mesh.positions;
  for (Vec3d& p : positions) p = {1.05 * p.x, p.y + 0.02 * sin_turns(3 * p.x + 2 * p.z), 0.98 * p.z};
  body.set_positions(positions);
  const auto springs = static_cast<std::int64_t>(body.springs().size());
  for (auto _ : state) body.step(seconds);
  state.SetItemsProcessed(springs * state.iterations());
}

/// 100,489 vertices, 300,000 edges. Arguments: threads; the forces in addition to springs on edges.
void verlet(benchmark::State& state) {
  MassSpringOptions options;
  options.threads = static_cast<std::uint32_t>(state.range(0));
  if (state.range(1) >= 1) options.area_stiffness = 50;
  if (state.range(1) >= 2) options.bending_stiffness = 5;
  if (state.range(1) >= 3) options.max_strain = 0.1;
  time_steps(state, make_cloth(316, 316, 31.6, 31.6), options, 0.01);
}
BENCHMARK(verlet)
    ->ArgNames({"threads", "extras"})
    ->ArgsProduct({{1, 2}, {0, 1, 2, 3}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// The same with vertices in random order, so without locality.
void verlet_shuffled(benchmark::State& state) {
  TriangleMesh mesh = make_cloth(316, 316, 31.6, 31.6);
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  std::vector<std::uint32_t> place(count);
  for (std::uint32_t v = 0; v < count; ++v)
    place[v] = static_cast<std::uint32_t>((v * 65537ull + 11) % count);
  TriangleMesh shuffled = mesh;
  for (std::uint32_t v = 0; v < count; ++v) shuffled.positions[place[v]] = mesh.positions[v];
  for (Triangle& t : shuffled.triangles) {
    for (std::uint32_t& v : t) v = place[v];
  }
  MassSpringOptions options;
  options.threads = static_cast<std::uint32_t>(state.range(0));
  time_steps(state, shuffled, options, 0.01);
}
BENCHMARK(verlet_shuffled)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

/// A square sheet with that many vertices per side, hanging from two corners. Arguments: size, k h² / m,
/// threads.
void backward_euler(benchmark::State& state) {
  const auto side = static_cast<std::uint32_t>(state.range(0));
  MassSpringOptions options;
  options.integrator = Integrator::backward_euler;
  options.stiffness = static_cast<double>(state.range(1)) * 1e4;
  options.gravity = {0, -10, 0};
  options.fixed_vertices = {0, side - 1};
  options.threads = static_cast<std::uint32_t>(state.range(2));
  time_steps(state, make_cloth(side - 1, side - 1, 1, 1), options, 0.01);
}
BENCHMARK(backward_euler)
    ->ArgNames({"side", "stiffness", "threads"})
    ->ArgsProduct({{20, 40, 80, 142}, {0, 1, 100, 1000000}, {1, 2}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

/// The block of scenes/soft_block.toml, pulled at its whole top.
void soft_block(benchmark::State& state) {
  const TriangleMesh mesh = make_box({2, 1, 2}, 20);
  MassSpringOptions options{.integrator = Integrator::backward_euler,
                            .vertex_mass = 0.01,
                            .stiffness = 100,
                            .damping = 1,
                            .air_friction = 0.02,
                            .bending_stiffness = 50};
  if (state.range(0) == 1) options.volume_stiffness = 1000;
  options.threads = static_cast<std::uint32_t>(state.range(1));
  std::vector<Vec3d> forces(mesh.positions.size());
  for (std::uint32_t v = 0; v < forces.size(); ++v) {
    if (mesh.positions[v].y < -0.499) options.fixed_vertices.push_back(v);
    if (mesh.positions[v].y > 0.499) forces[v] = {0.02, 0.05, 0};
  }
  MassSpringBody body(mesh, options);
  body.set_external_forces(forces);
  const auto springs = static_cast<std::int64_t>(body.springs().size());
  for (auto _ : state) body.step(0.01);
  state.SetItemsProcessed(springs * state.iterations());
}
BENCHMARK(soft_block)
    ->ArgNames({"volume", "threads"})
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
