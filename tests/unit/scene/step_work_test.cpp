// The work of searches for steps is bounded: it does not grow with the length of the step, and elements that
// touch at the start take few searches. The tests count what the searches look at; they do not measure time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "answers/impact/step_search.hpp"
#include "supple/models.hpp"
#include "support/random.hpp"
#include "world/world.hpp"

namespace supple::step_work_test {

struct Body {
  TriangleMesh mesh;
  std::vector<Vec3d> ways;
};

Body body(TriangleMesh mesh, Vec3d place, Vec3d way, double apart, RandomNumbers& random) {
  Body result{std::move(mesh), {}};
  for (Vec3d& p : result.mesh.positions) {
    p += place;
    result.ways.push_back(way + apart * random.vector(1));
  }
  return result;
}

struct Work {
  std::uint64_t pairs = 0, decisions = 0;  ///< of nodes and elements; of exact arithmetic
};

/// The work of `max_step`, `collision_free_step` and `collision_free_steps`.
std::vector<Work> work_of(const std::vector<Body>& bodies, double length) {
  World world({.contacts = ContactKinds::continuous, .threads = 1});
  for (const Body& of : bodies) {
    std::vector<Vec3d> to = of.mesh.positions;
    for (std::size_t v = 0; v < to.size(); ++v) to[v] += length * of.ways[v];
    world.set_motion(world.add(of.mesh.positions, of.mesh.triangles, {.self_collision = true}, ""),
                     of.mesh.positions, to);
  }
  StepSearch search(world);
  std::vector<Work> work;
  const auto add = [&] {
    const StepStats& done = search.work();
    work.push_back({done.node_pairs_visited + done.vertex_face_candidates + done.edge_edge_candidates,
                    done.exact_fallbacks});
  };
  search.safe_step({}, {}, {});
  add();
  search.safe_step({}, StepOptions{}, {});
  add();
  search.safe_steps({}, {}, {});
  add();
  return work;
}

void expect_bounded(const std::vector<Body>& bodies, const std::vector<double>& short_lengths,
                    const std::string& what) {
  std::vector<Work> most(3);
  for (const double length : short_lengths) {
    const std::vector<Work> work = work_of(bodies, length);
    for (std::size_t i = 0; i < 3; ++i) {
      most[i].pairs = std::max(most[i].pairs, work[i].pairs);
      most[i].decisions = std::max(most[i].decisions, work[i].decisions);
    }
  }
  for (const double length : {1e3, 1e6, 1e9, 1e15, 1e30}) {
    const std::vector<Work> work = work_of(bodies, length);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(work[i].pairs, 4 * most[i].pairs) << what << " " << length << ", search " << i;
      EXPECT_LE(work[i].decisions, 3 * most[i].decisions + 1000) << what << " " << length << ", search " << i;
    }
  }
}

TEST(StepWork, DoesNotGrowWithTheLengthOfTheStep) {
  RandomNumbers random(1);
  const std::vector<double> lengths{1e-3, 1e-2, 1e-1, 1.0, 1e2};
  const TriangleMesh beam = make_box({4, 0.5, 0.5}, 3), ball = make_icosphere(6);
  expect_bounded({body(beam, {}, {}, 1, random), body(beam, {0, 0.6, 0}, {}, 1, random)}, lengths, "beams");
  expect_bounded({body(make_cloth(16, 16), {}, {}, 1, random)}, lengths, "cloth");
  std::vector<Body> deep, pile;
  for (int i = 0; i < 3; ++i) {
    deep.push_back(body(ball, {0.1 * i, 0.05 * i, 0}, {0.3 * i, 0.2, -0.1 * i}, 0.01, random));
    pile.push_back(body(ball, {2.001 * i, 0, 0}, {-0.5 * i, 0, 0.1}, 0.01, random));
  }
  expect_bounded(deep, lengths, "deep bodies");
  expect_bounded(pile, lengths, "pile");
}

/// The search compares no elements of objects that are far apart for the whole step.
TEST(StepWork, OfDistantObjectsIsThatOfNodes) {
  RandomNumbers random(2);
  std::vector<Body> bodies;
  for (int i = 0; i < 3; ++i)
    bodies.push_back(body(make_box({1, 1, 1}, 1), {100.0 * i, 0, 0}, {0, 1, 0}, 0, random));
  for (const Work& work : work_of(bodies, 1)) EXPECT_LT(work.pairs, 1000u);
}

}  // namespace supple::step_work_test
