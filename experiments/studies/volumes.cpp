#include "studies/studies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "inputs/placement.hpp"
#include "program_2007/replay.hpp"
#include "studies/shape_pair.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// Objects and their positions in each frame.
struct Poses {
  std::string name;
  std::vector<TriangleMesh> objects;
  std::vector<std::vector<std::vector<Vec3d>>> frames{};  // frame, object, vertex
};

std::vector<Poses> make_cases(const Request& request) {
  std::vector<Poses> cases;
  for (PosedPair& pair : posed_pairs(!request.quick, request.quick ? 16 : 64)) {
    Poses& added = cases.emplace_back(Poses{pair.name, {pair.a, pair.b.front()}});
    for (const TriangleMesh& b : pair.b) added.frames.push_back({pair.a.positions, b.positions});
  }
  // Every tenth step of scenes.
  for (const Table1Scene& scene : {mixed_scene(9), built_in_scene("three_humans")}) {
    Replay replay = replay_of(scene, request.seed, request.quick ? 5 : 40, 10);
    Poses& added = cases.emplace_back(Poses{replay.name + ", deforming", std::move(replay.objects)});
    for (Replay::Frame& frame : replay.frames) added.frames.push_back(std::move(frame.positions));
  }
  return cases;
}

/// One way to enclose and to build.
struct Choice {
  std::string name;
  BoundingVolume volume = BoundingVolume::aabb;
  SphereFit fit = SphereFit::vertices;
  ObjectOctreeOptions octree{};
};

/// Boxes first.
std::vector<Choice> volume_variants() {
  std::vector<Choice> variants;
  for (std::size_t v = 0; v < words<BoundingVolume>.size(); ++v) {
    const auto volume = static_cast<BoundingVolume>(v);
    if (volume != BoundingVolume::sphere) {
      variants.push_back({words<BoundingVolume>[v], volume});
      continue;
    }
    for (std::size_t f = 0; f < words<SphereFit>.size(); ++f)
      variants.push_back(
          {fmt::format("sphere ({})", words<SphereFit>[f]), volume, static_cast<SphereFit>(f)});
  }
  return variants;
}

/// The default first.
std::vector<Choice> build_variants() {
  std::vector<Choice> variants;
  for (std::size_t b = 0; b < words<ObjectOctreeBuild>.size(); ++b)
    variants.push_back({words<ObjectOctreeBuild>[b], BoundingVolume::aabb, SphereFit::vertices, {
                          .build = static_cast<ObjectOctreeBuild>(b)
                        }});
  return variants;
}

std::vector<ObjectId> add_all(Scene& scene, const Poses& shapes, const Choice& variant) {
  std::vector<ObjectId> ids;
  for (const TriangleMesh& mesh : shapes.objects)
    ids.push_back(scene.add(mesh, ObjectOptions{.octree = variant.octree}));
  return ids;
}

/// A number that differs when one contact differs, over all frames.
std::uint64_t add_contacts(std::uint64_t hash, std::span<const Contact> contacts) {
  for (const Contact& c : contacts) {
    for (const std::uint64_t id : {c.object_a.index, c.object_b.index, c.triangle_a, c.triangle_b})
      hash = cli::scrambled(hash ^ id);
  }
  return hash;
}

/// One row: sums over the frames; times are those of the fastest round.
void measure(const Poses& shapes, const Choice& variant, int rounds, Table& table) {
  Scene scene({.bounding_volume = variant.volume,
               .contact_points = false,
               .threads = 1,
               .comparison = {.sphere_fit = variant.fit}});
  double build = INFINITY, refit = INFINITY, query = INFINITY;
  std::uint64_t bytes = 0, object_pairs = 0, node_pairs = 0, tests = 0, candidates = 0, contacts = 0,
                hash = 0;
  std::vector<ObjectId> ids;
  for (int round = 0; round < rounds; ++round) {
    for (const ObjectId id : ids) scene.remove(id);
    build = std::min(build, seconds_of([&] { ids = add_all(scene, shapes, variant); }));
    double refits = 0, queries = 0;
    for (const auto& positions : shapes.frames) {
      for (std::size_t i = 0; i < ids.size(); ++i) scene.set_positions(ids[i], positions[i]);
      const TimedDetection detection(scene);
      refits += detection.refit;
      queries += detection.narrow + detection.exact;
      if (round > 0) continue;
      const StepStats& stats = detection.result->stats;
      object_pairs += stats.object_pairs;
      node_pairs += stats.node_pairs_visited;
      tests += stats.boxes_tested;
      candidates += stats.candidate_pairs;
      contacts += detection.result->contacts.size();
      hash = add_contacts(hash, detection.result->contacts);
    }
    refit = std::min(refit, refits);
    query = std::min(query, queries);
  }
  for (const ObjectId id : ids) bytes += SceneInspector(scene).octree_statistics(id).bytes;
  table.add({shapes.name, variant.name, build, refit, query, bytes, object_pairs, node_pairs, tests,
             candidates, contacts, fmt::format("{:016x}", hash)});
}

}  // namespace

Results run_volumes(const Request& request) {
  const std::vector<Poses> cases = make_cases(request);
  const std::vector<Choice> volumes = volume_variants(), builds = build_variants();
  Work work(cases.size() * (volumes.size() + builds.size()), request.show_progress);
  Results results;
  for (const bool is_volume : {true, false}) {
    Table& table = results.tables.emplace_back(Table{
        is_volume ? "volumes" : "volumes_builds",
        {"case", is_volume ? "volume" : "build", "build_seconds", "refit_seconds", "query_seconds", "bytes",
         "object_pairs", "node_pairs", "tests", "candidates", "contacts", "hash_of_contacts"}});
    for (const Poses& shapes : cases) {
      for (const Choice& variant : is_volume ? volumes : builds) {
        measure(shapes, variant, request.quick ? 2 : 5, table);
        work.done(1, fmt::format("{}, {}", shapes.name, variant.name));
      }
    }
  }
  return results;
}

}  // namespace supple::experiments
