#include <malloc.h>

#include <cmath>

#include "contest/baselines/limits.hpp"
#include "contest/cells/cells.hpp"
#include "supple/inspection.hpp"
#include "supple/scene.hpp"

namespace supple::benchmarks {
namespace {

class Ideal : public Contestant<DeformingCopies> {
 public:
  explicit Ideal(std::size_t per_slot) : per_slot_(per_slot) {}
  void prepare(const DeformingCopies& copies) override {
    refit_ = std::make_unique<IdealRefit>(copies.mesh(), per_slot_);
  }
  void frame(const DeformingCopies&) override { refit_->run(); }
  PairDigest pairs() const override { return {}; }

 private:
  std::size_t per_slot_;
  std::unique_ptr<IdealRefit> refit_;
};

/// The number of triangles per leaf of Supple's octree, so that the ideal refit writes as many boxes as
/// Supple.
std::size_t leaf_width(const DeformingCopies& copies) {
  Scene scene;
  const ObjectId object = scene.add(copies.positions(0), copies.triangles());
  return static_cast<std::size_t>(
      std::lround(SceneInspector(scene).octree_statistics(object).mean_leaf_size));
}

double heap_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

}  // namespace

void run_bandwidth(Output& output) {
  for (const unsigned threads : {1u, 2u}) {
    pin_to(0, static_cast<int>(threads));
    const struct {
      const char* name;
      std::size_t kilobytes;
    } sizes[] = {{"L2", 512}, {"L3", 8192}, {"memory", 262144}};
    for (const auto& [name, kilobytes] : sizes) {
      output.value(std::string(name) + " GB/s, " + std::to_string(threads) + " threads",
                   read_bandwidth(threads * kilobytes * 1024, threads));
    }
  }
}

void run_refit(const Choice& choice, const std::string& triangles, Output& output) {
  auto mesh = make_deforming_copies(triangles + "x1");
  if (!mesh) return output.skip("the bunny is not there; set SUPPLE_DATA");
  Turns<DeformingCopies, CopiesContestant> turns;
  turns.add("Supple", 1, make_supple_copies(1), *mesh);
  turns.add("ideal, 1 per slot", 1, std::make_unique<Ideal>(1), *mesh);
  turns.add("ideal, 4 per slot", 1, std::make_unique<Ideal>(4), *mesh);
  const std::size_t width = leaf_width(*mesh);
  turns.add("ideal, leaves as wide", 1, std::make_unique<Ideal>(width), *mesh);
  turns.run(
      choice, *mesh, [&] { mesh->advance(); }, [](const auto&, const auto&, const auto&) {});
  output.value("triangles", static_cast<double>(mesh->triangle_count()));
  output.value("triangles a leaf", static_cast<double>(width));
  output.records(turns.records());
}

void run_memory(const std::string& shape, bool moving, Output& output) {
  auto copies = make_deforming_copies(shape + "x2");
  if (!copies) return output.skip("the bunny is not there; set SUPPLE_DATA");
  const double before = heap_bytes();
  SceneOptions options;
  options.threads = 1;
  if (moving) options.contacts = ContactKinds::continuous;
  Scene scene(options);
  std::vector<ObjectId> objects;
  for (std::size_t i = 0; i < copies->copies(); ++i)
    objects.push_back(scene.add(copies->positions(i), copies->triangles()));
  std::vector<std::vector<Vec3f>> last(copies->copies());
  for (int frame = 0; frame < 3; ++frame) {
    for (std::size_t i = 0; i < objects.size(); ++i)
      last[i].assign(copies->positions(i).begin(), copies->positions(i).end());
    copies->advance();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (moving)
        scene.set_motion(objects[i], last[i], copies->positions(i));
      else
        scene.set_positions(objects[i], copies->positions(i));
    }
    scene.detect();
  }
  last = {};
  malloc_trim(0);
  const double held = heap_bytes() - before;
  double octrees = 0, positions = 0;
  for (const ObjectId object : objects) {
    octrees += static_cast<double>(SceneInspector(scene).octree_statistics(object).bytes);
    positions += static_cast<double>(scene.vertex_count(object) * sizeof(Vec3f));
  }
  const auto triangles = static_cast<double>(copies->triangle_count());
  output.value("triangles", triangles);
  output.value("heap bytes a triangle", held / triangles);
  output.value("octree bytes a triangle", octrees / triangles);
  output.value("positions bytes a triangle", positions / triangles);
}

void run_build(const Choice& choice, const std::string& shape, Output& output) {
  const auto copies = make_deforming_copies(shape + "x1");
  if (!copies) return output.skip("the bunny is not there; set SUPPLE_DATA");
  const auto time_add = [&](ObjectOctreeBuild build, std::uint32_t threads) {
    SceneOptions options;
    options.threads = threads;
    Scene scene(options);
    ObjectOptions object;
    object.octree.build = build;
    const double start = wall_milliseconds();
    scene.add(copies->positions(0), copies->triangles(), object);
    return wall_milliseconds() - start;
  };
  std::vector<double> balanced, regular, on_two_threads;
  const double begin = wall_milliseconds();
  while (balanced.size() < 3 ||
         (balanced.size() < choice.rounds && wall_milliseconds() - begin < 1e3 * choice.seconds)) {
    balanced.push_back(time_add(ObjectOctreeBuild::balanced, 1));
    regular.push_back(time_add(ObjectOctreeBuild::regular, 1));
    on_two_threads.push_back(time_add(ObjectOctreeBuild::balanced, 2));
  }
  output.value("triangles", static_cast<double>(copies->triangle_count()));
  output.value("milliseconds, balanced", quantile(balanced, 0.5));
  output.value("milliseconds, regular", quantile(regular, 0.5));
  output.value("milliseconds, balanced, 2 threads", quantile(on_two_threads, 0.5));
}

void run_scale(const Choice& choice, const std::string& triangles, Output& output) {
  auto sphere = make_deforming_copies(triangles + "x1");
  const auto count = static_cast<double>(sphere->triangle_count());
  output.value("triangles", count);
  const auto time = [&](const std::string& name, const auto& work) {
    const double start = cpu_milliseconds();
    work();
    output.value("milliseconds, " + name, cpu_milliseconds() - start);
  };
  {
    const double before = heap_bytes();
    SceneOptions options;
    options.threads = 1;
    Scene scene(options);
    ObjectId object;
    time("build",
         [&] { object = scene.add(sphere->positions(0), sphere->triangles(), {.self_collision = true}); });
    const auto frame = [&] {
      sphere->advance();
      scene.share_positions(object, sphere->positions(0));
    };
    for (const char* const name : {"first frame", "second frame", "third frame", "frame"}) {
      frame();
      time(name, [&] { scene.detect(); });
    }
    output.value("milliseconds, refit", 1e3 * scene.result().stats.refit_seconds);
    output.value("heap bytes a triangle", (heap_bytes() - before) / count);
  }
  for (const auto& entry : other_copies_contestants()) {
    if (entry.name != "Embree" || choice.only_supple) continue;
    const auto embree = entry.make();
    time("Embree, build", [&] { embree->prepare(*sphere); });
    sphere->advance();
    embree->frame(*sphere);
    sphere->advance();
    time("Embree, refit", [&] { embree->frame(*sphere); });
  }
}

void run_frames(const Choice& choice, const std::string& name, Output& output) {
  auto copies = make_deforming_copies(name);
  if (!copies) return output.skip("the bunny is not there; set SUPPLE_DATA");
  const auto supple = make_supple_copies(1);
  supple->prepare(*copies);
  std::vector<double> times;
  const std::size_t frames = choice.rounds == Choice().rounds ? 10'000 : choice.rounds;
  constexpr std::size_t warm_up = 20;  // buffers still grow
  for (std::size_t frame = 0; frame < frames + warm_up; ++frame) {
    copies->advance();
    const double start = wall_milliseconds();
    supple->frame(*copies);
    if (frame >= warm_up) times.push_back(wall_milliseconds() - start);
  }
  output.value("frames", static_cast<double>(frames));
  output.value("milliseconds, median", quantile(times, 0.5));
  output.value("milliseconds, 99th percentile", quantile(times, 0.99));
  output.value("milliseconds, 99.9th percentile", quantile(times, 0.999));
  output.value("milliseconds, longest", quantile(times, 1));
}

}  // namespace supple::benchmarks
