#include "program_2007/program_2007.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "program_2007/replay.hpp"
#include "supple/scene.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

using Box = std::array<Vec3d, 2>;
/// Two objects and a triangle of each.
using TrianglePairs = std::set<std::array<std::uint32_t, 4>>;

bool overlap(const Box& a, const Box& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a[1][axis] < b[0][axis] || b[1][axis] < a[0][axis]) return false;
  }
  return true;
}

Box box_of(const std::vector<Vec3d>& positions, const Triangle& triangle) {
  return bounds_of(std::array{positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]});
}

/// What a trial finds in one frame.
struct Found {
  std::uint64_t vertices_read = 0;
  TrianglePairs candidates{};  ///< pairs of triangles whose boxes overlap
};

/// A triangle of an object that a trial keeps, with its box.
struct Kept {
  std::uint32_t triangle;
  Box box;
};

void add_candidates(std::uint32_t a, std::uint32_t b, const std::vector<Kept>& of_a,
                    const std::vector<Kept>& of_b, Found& found) {
  for (const Kept& first : of_a) {
    for (const Kept& second : of_b) {
      if (overlap(first.box, second.box)) found.candidates.insert({a, b, first.triangle, second.triangle});
    }
  }
}

/// Calls `visit(a, b)` for each two objects whose boxes overlap.
template <class Visit>
void for_each_pair(const Replay::Frame& frame, const Visit& visit) {
  const auto count = static_cast<std::uint32_t>(frame.bounds.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      if (overlap(frame.bounds[a], frame.bounds[b])) visit(a, b);
    }
  }
}

/// The triangles of an object that reach into one of the regions. Reads all of its vertices.
std::vector<Kept> triangles_in(const Replay& replay, const Replay::Frame& frame, std::uint32_t object,
                               const std::vector<Box>& regions, Found& found) {
  std::vector<Kept> kept;
  found.vertices_read += frame.positions[object].size();
  const std::vector<Triangle>& triangles = replay.objects[object].triangles;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Box box = box_of(frame.positions[object], triangles[t]);
    if (std::any_of(regions.begin(), regions.end(), [&](const Box& region) { return overlap(region, box); }))
      kept.push_back({t, box});
  }
  return kept;
}

/// The third trial: the region that the boxes of two objects have in common.
Found by_common_region(const Replay& replay, const Replay::Frame& frame) {
  Found found;
  for_each_pair(frame, [&](std::uint32_t a, std::uint32_t b) {
    Box common;
    for (int axis = 0; axis < 3; ++axis) {
      common[0][axis] = std::max(frame.bounds[a][0][axis], frame.bounds[b][0][axis]);
      common[1][axis] = std::min(frame.bounds[a][1][axis], frame.bounds[b][1][axis]);
    }
    add_candidates(a, b, triangles_in(replay, frame, a, {common}, found),
                   triangles_in(replay, frame, b, {common}, found), found);
  });
  return found;
}

/// The cubes into which a level divides the cube of the scene.
std::vector<Box> regions_of_level(const RootCube& root, int level) {
  const int count = 1 << level;
  const double edge = root.edge / count;
  std::vector<Box> regions;
  for (int z = 0; z < count; ++z) {
    for (int y = 0; y < count; ++y) {
      for (int x = 0; x < count; ++x) {
        const Vec3d low = root.corner + Vec3d{x * edge, y * edge, z * edge};
        regions.push_back({low, low + Vec3d{edge, edge, edge}});
      }
    }
  }
  // The outermost regions also contain what is beyond the root.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (Box& region : regions) {
    for (int axis = 0; axis < 3; ++axis) {
      if (region[0][axis] <= root.corner[axis]) region[0][axis] = -infinity;
      if (region[1][axis] >= root.corner[axis] + root.edge * (1 - 1e-9)) region[1][axis] = infinity;
    }
  }
  return regions;
}

/// The second trial: the regions of the scene octree that both objects are in.
Found by_regions(const Replay& replay, const Replay::Frame& frame, const std::vector<Box>& regions) {
  Found found;
  for_each_pair(frame, [&](std::uint32_t a, std::uint32_t b) {
    std::vector<Box> common;
    for (const Box& region : regions) {
      if (overlap(region, frame.bounds[a]) && overlap(region, frame.bounds[b])) common.push_back(region);
    }
    add_candidates(a, b, triangles_in(replay, frame, a, common, found),
                   triangles_in(replay, frame, b, common, found), found);
  });
  return found;
}

/// The first trial: the vertices around those that collided in the frame before. A pair whose boxes did not
/// overlap then is searched as a whole.
class Neighbours {
 public:
  explicit Neighbours(const Replay& replay) : replay_(replay) {
    for (const TriangleMesh& mesh : replay.objects) {
      auto& around = around_.emplace_back(mesh.positions.size());
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t vertex : mesh.triangles[t]) around[vertex].push_back(t);
      }
    }
  }

  Found find(const Replay::Frame& frame) {
    constexpr int rings = 2;
    Found found;
    std::set<std::pair<std::uint32_t, std::uint32_t>> near;
    for_each_pair(frame, [&](std::uint32_t a, std::uint32_t b) {
      near.emplace(a, b);
      const bool is_new = !near_.contains({a, b});
      std::array<std::vector<Kept>, 2> kept;
      for (const int side : {0, 1}) {
        const std::uint32_t object = side == 0 ? a : b;
        const std::vector<Triangle>& triangles = replay_.objects[object].triangles;
        std::set<std::uint32_t> wanted;
        for (std::uint32_t t = 0; is_new && t < triangles.size(); ++t) wanted.insert(t);
        for (const auto& pair : before_) {
          if (pair[0] == a && pair[1] == b) wanted.insert(pair[side == 0 ? 2 : 3]);
        }
        for (int ring = 0; !is_new && ring < rings; ++ring) {
          for (const std::uint32_t t : std::set<std::uint32_t>(wanted)) {
            for (const std::uint32_t vertex : triangles[t])
              wanted.insert(around_[object][vertex].begin(), around_[object][vertex].end());
          }
        }
        std::set<std::uint32_t> vertices;
        for (const std::uint32_t t : wanted) {
          kept[static_cast<std::size_t>(side)].push_back({t, box_of(frame.positions[object], triangles[t])});
          vertices.insert(triangles[t].begin(), triangles[t].end());
        }
        found.vertices_read += vertices.size();
      }
      add_candidates(a, b, kept[0], kept[1], found);
    });
    before_ = found.candidates;
    near_ = std::move(near);
    return found;
  }

 private:
  const Replay& replay_;
  std::vector<std::vector<std::vector<std::uint32_t>>> around_;  // triangles, by object and vertex
  TrianglePairs before_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> near_;
};

/// The pairs of triangles that intersect in each frame, decided exactly.
std::vector<TrianglePairs> exact_pairs(const Replay& replay) {
  Scene scene({.contact_points = false});
  std::vector<ObjectId> ids;
  for (const TriangleMesh& mesh : replay.objects) ids.push_back(scene.add(mesh));
  std::vector<TrianglePairs> all;
  for (const Replay::Frame& frame : replay.frames) {
    for (std::size_t i = 0; i < ids.size(); ++i) scene.set_positions(ids[i], frame.positions[i]);
    TrianglePairs& pairs = all.emplace_back();
    for (const Contact& c : scene.detect().contacts)
      pairs.insert({c.object_a.index, c.object_b.index, c.triangle_a, c.triangle_b});
  }
  return all;
}

/// What a trial reads and finds in a frame, on average.
template <class Find>
void measure(const Replay& replay, const std::vector<TrianglePairs>& exact, const char* trial, int round,
             Find find, Table& table) {
  double seconds = 0, vertices = 0, candidates = 0, contacts = 0, missed = 0;
  const auto frames = static_cast<double>(replay.frames.size());
  for (std::size_t f = 0; f < replay.frames.size(); ++f) {
    Found found;
    seconds += seconds_of([&] { found = find(replay.frames[f]); });
    vertices += static_cast<double>(found.vertices_read);
    candidates += static_cast<double>(found.candidates.size());
    contacts += static_cast<double>(exact[f].size());
    for (const auto& pair : exact[f]) missed += found.candidates.contains(pair) ? 0 : 1;
  }
  table.add({replay.name, std::string(trial), static_cast<std::uint64_t>(round), seconds / frames,
             vertices / frames, candidates / frames, contacts / frames, missed / frames});
}

void measure_all(const Replay& replay, int rounds, Work& work, Table& table) {
  const std::vector<TrianglePairs> exact = exact_pairs(replay);
  const std::vector<Box> regions = regions_of_level(cube_around((*replay.border)[0], (*replay.border)[1]), 2);
  const Program program = program_of_2007(replay.border);
  ReplayedScene hierarchy(replay, program);
  const auto frames = static_cast<double>(replay.frames.size());
  for (int round = 0; round < rounds; ++round) {
    // Its candidates are its pairs of leaves, and a corner that it reads is a vertex read.
    const ReplaySums sums = hierarchy.run();
    table.add({replay.name, "the hierarchy", static_cast<std::uint64_t>(round), sums.total / frames,
               3 * static_cast<double>(sums.triangles_refitted) / frames,
               static_cast<double>(sums.candidates) / frames, Cell(), Cell()});
    Neighbours neighbours(replay);
    measure(
        replay, exact, "neighbours of a vertex", round,
        [&](const Replay::Frame& frame) { return neighbours.find(frame); }, table);
    measure(
        replay, exact, "regions of the scene octree", round,
        [&](const Replay::Frame& frame) { return by_regions(replay, frame, regions); }, table);
    measure(
        replay, exact, "the common region", round,
        [&](const Replay::Frame& frame) { return by_common_region(replay, frame); }, table);
    work.done(1, replay.name);
  }
}

/// What a refit of all objects reads in a frame, and one of the objects whose boxes overlap another.
void add_corners(const Replay& replay, Table& table) {
  double all = 0, in_pairs = 0;
  for (const TriangleMesh& mesh : replay.objects) all += 3 * static_cast<double>(mesh.triangles.size());
  for (const Replay::Frame& frame : replay.frames) {
    std::set<std::uint32_t> objects;
    for_each_pair(frame, [&](std::uint32_t a, std::uint32_t b) { objects.insert({a, b}); });
    for (const std::uint32_t object : objects)
      in_pairs += 3 * static_cast<double>(replay.objects[object].triangles.size());
  }
  table.add({replay.name, all, in_pairs / static_cast<double>(replay.frames.size())});
}

/// Objects in the regions of a level, as cubes and as the spheres around these cubes.
void add_spheres(const Replay& replay, Table& table) {
  const RootCube root = cube_around((*replay.border)[0], (*replay.border)[1]);
  for (const int level : {1, 2, 3}) {
    const std::vector<Box> regions = regions_of_level(root, level);
    std::uint64_t in_cubes = 0, in_spheres = 0, pairs_of_cubes = 0, pairs_of_spheres = 0;
    const double radius = std::sqrt(3.0) / 2 * root.edge / (1 << level);
    const auto pairs = [](std::uint64_t objects) { return objects * (objects - 1) / 2; };
    for (const Replay::Frame& frame : replay.frames) {
      for (std::size_t r = 0; r < regions.size(); ++r) {
        const int count = 1 << level,
                  at[3] = {static_cast<int>(r) % count, static_cast<int>(r) / count % count,
                           static_cast<int>(r) / count / count};
        Vec3d centre = root.corner;
        for (int axis = 0; axis < 3; ++axis) centre[axis] += (at[axis] + 0.5) * root.edge / count;
        std::uint64_t cube = 0, sphere = 0;
        for (const Box& bounds : frame.bounds) {
          const Vec3d middle = (bounds[0] + bounds[1]) * 0.5, half = (bounds[1] - bounds[0]) * 0.5;
          const double of_object = std::sqrt(dot(half, half));
          cube += overlap(regions[r], bounds);
          sphere += norm(middle - centre) <= radius + of_object;
        }
        in_cubes += cube;
        in_spheres += sphere;
        pairs_of_cubes += cube > 1 ? pairs(cube) : 0;
        pairs_of_spheres += sphere > 1 ? pairs(sphere) : 0;
      }
    }
    const auto frames = static_cast<double>(replay.frames.size());
    table.add({replay.name, static_cast<std::uint64_t>(level), static_cast<double>(in_cubes) / frames,
               static_cast<double>(in_spheres) / frames, static_cast<double>(pairs_of_cubes) / frames,
               static_cast<double>(pairs_of_spheres) / frames});
  }
}

}  // namespace

Results run_trials(const Request& request) {
  std::vector<Table1Scene> scenes{mixed_scene(9), built_in_scene("nine")};
  if (!request.quick) scenes.push_back(built_in_scene("three_humans"));
  const int frames = request.quick ? 20 : 100, rounds = request.quick ? 3 : 7;
  Table trials{"trials",
               {"scene", "trial", "round", "seconds", "vertices", "candidates", "contacts", "missed"}},
      corners{"trials_corners", {"scene", "all", "in_pairs"}},
      spheres{"trials_spheres",
              {"scene", "level", "in_cubes", "in_spheres", "pairs_in_cubes", "pairs_in_spheres"}};
  Work work(scenes.size() * static_cast<std::uint64_t>(rounds), request.show_progress);
  for (const Table1Scene& scene : scenes) {
    const Replay replay = replay_of(scene, request.seed, frames, 5);
    measure_all(replay, rounds, work, trials);
    add_corners(replay, corners);
    add_spheres(replay, spheres);
  }
  return {{std::move(trials), std::move(corners), std::move(spheres)}};
}

}  // namespace supple::experiments
