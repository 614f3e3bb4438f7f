// Benchmarks of single stages through the public headers, on models that need no files. One thread unless
// the name says otherwise.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

namespace {

using namespace supple;

/// A sphere whose radius oscillates; the same at each step on every machine.
std::vector<Vec3d> deformed(const TriangleMesh& mesh, Vec3d center, double turns) {
  std::vector<Vec3d> positions;
  positions.reserve(mesh.positions.size());
  for (const Vec3d& p : mesh.positions) {
    positions.push_back(center + p * (1 + 0.04 * sin_turns(0.5 * p.x + 0.6 * p.y + turns) +
                                      0.015 * sin_turns(1.4 * p.z - 1.1 * p.x + 1.7 * turns)));
  }
  return positions;
}

template <class Scalar>
std::vector<Vec3<Scalar>> converted(const std::vector<Vec3d>& positions) {
  std::vector<Vec3<Scalar>> result;
  for (const Vec3d& p : positions) {
    result.push_back({static_cast<Scalar>(p.x), static_cast<Scalar>(p.y), static_cast<Scalar>(p.z)});
  }
  return result;
}

void count_items(benchmark::State& state, std::uint64_t items_per_step) {
  state.SetItemsProcessed(static_cast<std::int64_t>(items_per_step) * state.iterations());
}

/// Builds the octree of one object. Items are triangles.
void build_octree(benchmark::State& state) {
  const TriangleMesh mesh = make_icosphere(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) {
    Scene scene({.threads = 1});
    scene.add(mesh);
  }
  count_items(state, mesh.triangles.size());
}
BENCHMARK(build_octree)->Arg(7)->Arg(30)->Arg(59)->Unit(benchmark::kMillisecond);

/// Writes new positions into the octree: copy and refit. Items are triangles.
template <class Scalar>
void refit(benchmark::State& state) {
  const TriangleMesh mesh = make_icosphere(static_cast<std::uint32_t>(state.range(0)));
  Scene scene({.threads = 1});
  const ObjectId object = scene.add(mesh);
  const auto positions = converted<Scalar>(deformed(mesh, {}, 0.1));
  for (auto _ : state) {
    scene.set_positions(object, positions);
    benchmark::DoNotOptimize(scene.detect().contacts.size());
  }
  count_items(state, mesh.triangles.size());
}
BENCHMARK(refit<float>)->Arg(7)->Arg(30)->Arg(59)->Unit(benchmark::kMicrosecond);
BENCHMARK(refit<double>)->Arg(7)->Arg(30)->Arg(59)->Unit(benchmark::kMicrosecond);

/// A whole step: spheres on a lattice that deform and overlap their neighbours. Arguments: frequency,
/// objects per side, threads. Counters are the milliseconds of each stage.
void step(benchmark::State& state) {
  const TriangleMesh mesh = make_icosphere(static_cast<std::uint32_t>(state.range(0)));
  const auto side = static_cast<int>(state.range(1));
  Scene scene({.threads = static_cast<std::uint32_t>(state.range(2))});
  std::vector<ObjectId> objects;
  std::vector<std::vector<Vec3f>> frames[2];
  for (int i = 0; i < side * side * side; ++i) {
    const Vec3d center = Vec3d{1.0 * (i % side), 1.0 * (i / side % side), 1.0 * (i / side / side)} * 1.9;
    objects.push_back(scene.add(mesh));
    for (int frame = 0; frame < 2; ++frame) {
      frames[frame].push_back(converted<float>(deformed(mesh, center, 0.137 * i + 0.1 * frame)));
    }
  }
  StepStats sum;
  std::size_t contacts = 0;
  int frame = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < objects.size(); ++i) scene.set_positions(objects[i], frames[frame][i]);
    const DetectResult& result = scene.detect();
    contacts = result.contacts.size();
    sum.refit_seconds += result.stats.refit_seconds;
    sum.broad_phase_seconds += result.stats.broad_phase_seconds;
    sum.traversal_seconds += result.stats.traversal_seconds;
    sum.exact_seconds += result.stats.exact_seconds;
    sum.sort_and_events_seconds += result.stats.sort_and_events_seconds;
    frame = 1 - frame;
  }
  const auto milliseconds = [&](double seconds) {
    return benchmark::Counter(1e3 * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["refit"] = milliseconds(sum.refit_seconds);
  state.counters["broad"] = milliseconds(sum.broad_phase_seconds);
  state.counters["traversal"] = milliseconds(sum.traversal_seconds);
  state.counters["exact"] = milliseconds(sum.exact_seconds);
  state.counters["finish"] = milliseconds(sum.sort_and_events_seconds);
  state.counters["contacts"] = static_cast<double>(contacts);
  count_items(state, mesh.triangles.size() * objects.size());
}
BENCHMARK(step)
    ->Args({7, 4, 1})
    ->Args({30, 2, 1})
    ->Args({30, 4, 1})
    ->Args({30, 4, 2})
    ->Args({59, 2, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Unit cubes in a cube of side 2 n^(1/3); all move in every step. Arguments: n, method.
void broad_phase(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const double side = 2 * std::cbrt(static_cast<double>(count));
  std::uint64_t bits = 88172645463325252u;  // xorshift
  const auto uniform = [&] {
    bits ^= bits << 13;
    bits ^= bits >> 7;
    bits ^= bits << 17;
    return static_cast<double>(bits >> 11) * 0x1p-53;
  };
  std::vector<Vec3d> lower(count), velocity(count);
  for (std::size_t i = 0; i < count; ++i) {
    lower[i] = {uniform() * side, uniform() * side, uniform() * side};
    velocity[i] = {uniform() - 0.5, uniform() - 0.5, uniform() - 0.5};
  }
  BroadPhase broad(
      {.method = static_cast<BroadPhaseMethod>(state.range(1)), .scene_octree = {}, .threads = 1});
  std::vector<Aabb> boxes(count);
  double time = 0;
  std::size_t pairs = 0;
  for (auto _ : state) {
    state.PauseTiming();
    time = time > 20 ? 0 : time + 0.2;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d p = lower[i] + velocity[i] * time;
      boxes[i].min = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      boxes[i].max = {boxes[i].min.x + 1, boxes[i].min.y + 1, boxes[i].min.z + 1};
    }
    state.ResumeTiming();
    pairs = broad.find_object_pairs(boxes).size();
  }
  state.counters["pairs"] = static_cast<double>(pairs);
  count_items(state, count);
}
BENCHMARK(broad_phase)
    ->ArgsProduct({{1000, 10000, 100000},
                   {static_cast<int>(BroadPhaseMethod::octree), static_cast<int>(BroadPhaseMethod::grid),
                    static_cast<int>(BroadPhaseMethod::sweep), static_cast<int>(BroadPhaseMethod::sweep3)}})
    ->Args({10000, static_cast<int>(BroadPhaseMethod::brute)})
    ->Unit(benchmark::kMillisecond);

/// Exact triangle tests: separated by a plane, crossing, and touching within one plane.
void triangle_pair(benchmark::State& state) {
  const TrianglePoints a{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const TrianglePoints others[] = {{{{0.1, 0.1, 0.2}, {0.9, 0.1, 0.3}, {0.2, 0.8, 0.1}}},
                                   {{{0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 0.4, 1}}},
                                   {{{0.5, 0.5, 0}, {1, 1, 0}, {2, 0.5, 0}}}};
  const TrianglePoints& b = others[state.range(0)];
  for (auto _ : state) benchmark::DoNotOptimize(intersect_triangles(a, b).intersects);
}
BENCHMARK(triangle_pair)->DenseRange(0, 2);

/// One continuous query for edges: far apart, apart because their coplanar times do not match, touching,
/// sliding in one plane until they touch at a corner, and reaching the distance 0.05.
void first_impact_of_edges(benchmark::State& state) {
  const std::array<Vec3d, 2> a0{{{0, 0, 0}, {1, 0.1, 0}}};
  struct Query {
    std::array<Vec3d, 4> start, end;
    double separation = 0;
  };
  const Query queries[] = {
      {{a0[0], a0[1], {0.5, -1, 2}, {0.5, 1, 2.5}}, {a0[0], a0[1], {0.5, -1, 1}, {0.5, 1, 1.5}}},
      {{a0[0], a0[1], {1.5, -1, 1}, {1.5, 1, 1.2}}, {a0[0], a0[1], {1.2, -1, -1}, {1.4, 1, -0.8}}},
      {{a0[0], a0[1], {0.5, -1, 1}, {0.5, 1, 1.2}}, {a0[0], a0[1], {0.4, -1, -1}, {0.6, 1, -0.8}}},
      {{a0[0], a0[1], {2, 0, 0}, {2, 1, 0}}, {a0[0], a0[1], {1, 0.1, 0}, {1, 1.1, 0}}},
      {{a0[0], a0[1], {0.5, -1, 1}, {0.5, 1, 1.2}}, {a0[0], a0[1], {0.4, -1, -1}, {0.6, 1, -0.8}}, 0.05}};
  const auto& [start, end, separation] = queries[state.range(0)];
  const EdgeEdgeMotion motion{start, end};
  const ImpactOptions options{.min_separation = separation};
  for (auto _ : state) benchmark::DoNotOptimize(first_impact(motion, options).has_value());
}
BENCHMARK(first_impact_of_edges)->DenseRange(0, 4);

/// A cloth against itself, crumpled at both ends of the step. Arguments: squares per side, threads, whether
/// only the earliest impact is needed. Items are triangles.
void continuous_step(benchmark::State& state) {
  const auto squares = static_cast<std::uint32_t>(state.range(0));
  const TriangleMesh cloth = make_cloth(squares, squares);
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  options.threads = static_cast<std::uint32_t>(state.range(1));
  Scene scene(options);
  const ObjectId id = scene.add(cloth, {.self_collision = true});
  std::vector<Vec3d> from, to;
  for (const Vec3d& p : cloth.positions) {  // folds that pass through each other
    const double wave = sin_turns(3 * p.x), other = sin_turns(2.5 * p.z + 0.2);
    const double bend = 0.02 * sin_turns(1.7 * p.x + 2.3 * p.z), shift = 0.01 * sin_turns(p.x - 3.1 * p.z);
    from.push_back({0.3 * p.x + 0.1 * wave + bend, 0.2 * wave * other, p.z + shift});
    to.push_back({0.3 * p.x + 0.12 * wave - bend, 0.2 * wave * other + 0.02 * p.z, p.z - shift});
  }
  StepStats sum;
  std::size_t contacts = 0;
  for (auto _ : state) {
    scene.set_motion(id, from, to);
    if (state.range(2) != 0) {
      contacts = scene.earliest_impact().has_value() ? 1 : 0;
      continue;
    }
    const DetectResult& result = scene.detect();
    contacts = result.continuous_contacts.size();
    sum.traversal_seconds += result.stats.traversal_seconds;
    sum.exact_seconds += result.stats.exact_seconds;
  }
  state.counters["candidates_ms"] =
      benchmark::Counter(1e3 * sum.traversal_seconds, benchmark::Counter::kAvgIterations);
  state.counters["verdicts_ms"] =
      benchmark::Counter(1e3 * sum.exact_seconds, benchmark::Counter::kAvgIterations);
  state.counters["contacts"] = static_cast<double>(contacts);
  count_items(state, cloth.triangles.size());
}
BENCHMARK(continuous_step)
    ->ArgsProduct({{64, 200}, {1, 2}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
