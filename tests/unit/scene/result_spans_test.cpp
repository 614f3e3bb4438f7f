// The spans of a result last until the next `detect`, those of a query until the next query of that name.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/result_lists.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/option_word.hpp"

namespace supple::result_spans_test {

/// Spans with the bytes that they had.
class HeldSpans {
 public:
  template <class Item>
  void hold(std::span<const Item> items) {
    const auto bytes = std::as_bytes(items);
    held_.push_back({bytes, {bytes.begin(), bytes.end()}});
  }
  void hold(const PairEvents& events) {
    for (const auto pairs : {events.begin, events.stay, events.end}) hold(pairs);
  }
  void hold(const DetectResult& r) {
    const auto hold_all = [&](const auto&... spans) { (hold(spans), ...); };
    hold_all(r.object_pairs, r.groups, r.contacts, r.contact_points, r.continuous_groups,
             r.continuous_contacts, r.proximity_groups, r.proximity_pairs, r.penetration_groups,
             r.penetrations, r.vertices_on_surface, r.contained_parts, r.curves, r.curve_contacts,
             r.curve_points, r.enclosed_vertices, r.manifolds, r.manifold_points, r.ended_manifolds,
             r.colliding_vertex_groups, r.colliding_vertices, r.non_finite_vertices, r.volume_events,
             r.narrow_phase_events, r.contact_events, r.proximity_events, r.penetration_events);
  }
  /// The number of spans that have bytes, all of which must be as they were.
  std::size_t check(const char* after) const {
    std::size_t filled = 0;
    for (const auto& [span, bytes] : held_) {
      filled += bytes.empty() ? 0 : 1;
      EXPECT_TRUE(bytes.empty() || std::memcmp(span.data(), bytes.data(), bytes.size()) == 0)
          << "a span changed after " << after;
    }
    return filled;
  }

 private:
  struct Held {
    std::span<const std::byte> span;
    std::vector<std::byte> bytes;
  };
  std::vector<Held> held_;
};

class ResultSpans : public testing::TestWithParam<OptionWord<ContinuousListing>> {};

/// Options with which a result has all lists.
SceneOptions all_lists(ContinuousListing listing) {
  constexpr ContactKinds all = ContactKinds::intersection | ContactKinds::continuous |
                               ContactKinds::proximity | ContactKinds::penetration;
  SceneOptions options{.contacts = all, .continuous_listing = listing, .manifolds = true};
  options.comparison.colliding_vertices = true;
  return options;
}

TEST_P(ResultSpans, OnlyDetectEndsThem) {
  Scene scene(all_lists(GetParam()));
  const TriangleMesh ball = make_icosphere(4);
  std::vector<Vec3d> up = ball.positions, broken = ball.positions;
  for (Vec3d& p : up) p = p + Vec3d{0.1, 0.7, 0.2};
  for (Vec3d& p : broken) p.x += 3;
  broken[0].x = std::numeric_limits<double>::quiet_NaN();
  const ObjectId a = scene.add(ball, {.self_collision = true, .margin = 0.05, .solid = true});
  const ObjectId b = scene.add(ball, {.margin = 0.05, .solid = true});
  const ObjectId c = scene.add(make_icosphere(2), {.margin = 0.05});  // inside both
  scene.set_transform(c, {{0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1}, {0.05, 0.4, 0.1}});
  const ObjectId d = scene.add(ball);
  scene.set_motion(b, ball.positions, up);
  scene.set_positions(d, broken);
  scene.detect();
  HeldSpans held;
  held.hold(scene.detect());
  EXPECT_GT(held.check("nothing"), 18u);

  const std::vector<Vec3d> points{{0, 0, 0}, {0.1, 0.2, 3}};
  const std::vector<Ray> rays{{{0, 0, -3}, {0, 0, 1}}, {{0.1, 0.2, -3}, {0, 0, 1}}};
  std::vector<std::optional<ClosestPoint>> nearest(2);
  std::vector<std::optional<RayHit>> hits(2);
  std::vector<Containment> sides(2);
  const auto query = [&] {
    scene.closest(points, nearest);
    scene.cast(rays, hits);
    scene.inside(points, sides, {.object = a});
    scene.distance(a, b);
    scene.any_contact(a, b);
    scene.earliest_impact();
    scene.max_step();
    scene.collision_free_step();
    scene.cast_all(rays);
    scene.distances(10);
    held.check("queries");
  };
  query();
  constexpr ContactKinds searched =
      ContactKinds::intersection | ContactKinds::continuous | ContactKinds::proximity;
  HeldSpans of_search;
  of_search.hold(scene.search({.contacts = searched}));
  EXPECT_GT(of_search.check("nothing"), 6u);
  held.check("search");

  scene.set_motion(a, up, ball.positions);
  held.check("set_motion");
  query();
  scene.set_positions(b, ball.positions);
  scene.set_vertices(b, std::vector<std::uint32_t>{0}, std::vector<Vec3d>{{0, 0, 9}});
  scene.share_positions(d, up);
  scene.translate(a, {0.5, 0, 0});
  scene.set_transform(a, RigidTransform::from_quaternion(1, 2, 3, 4));
  scene.set_options(a, {.group = 3, .mask = 3});
  scene.set_options(a, {.margin = 0.2});
  scene.set_options(a, {.min_separation = 0.1});
  scene.set_options(a, {.user_data = 7});
  scene.set_vertex_groups(d, std::vector<std::uint32_t>(ball.positions.size(), 1),
                          std::vector<std::uint32_t>(ball.positions.size(), 1));
  scene.set_options(b, {.self_collision = true});
  scene.set_pair_filter([](ObjectId, ObjectId) { return true; });
  scene.set_options(d, {.is_static = true});
  held.check("changes of objects");
  query();
  scene.remove(c);
  for (int i = 0; i < 50; ++i) scene.translate(scene.add(ball), {10.0 + 5 * i, 0, 0});
  held.check("remove and add");
  query();
  Scene other = std::move(scene);
  EXPECT_GT(held.check("a move of the scene"), 18u);
  EXPECT_GT(of_search.check("queries and changes"), 6u);
  other.search({.contacts = searched});
  held.check("another search");
  other.set_vertex_groups(d, {}, {});
  EXPECT_EQ(other.detect().step, 2u);
}

/// A kept result outlives the next steps and the scene, and the steps are those of a scene that keeps none.
TEST_P(ResultSpans, AreKeptOnRequest) {
  const TriangleMesh ball = make_icosphere(2);
  std::vector<Vec3d> moved = ball.positions;
  const auto make = [&] {
    Scene scene(all_lists(GetParam()));
    for (int i = 0; i < 3; ++i) {
      scene.add(ball, {.self_collision = true, .margin = 0.05, .solid = true});
      scene.translate(scene.objects().back(), {0.6 * i, 0, 0});
    }
    return scene;
  };
  Scene plain = make();
  std::optional<Scene> keeping = make();
  HeldSpans held;
  std::vector<std::shared_ptr<const void>> kept;
  EXPECT_NE(keeping->keep_result(), nullptr);  // before the first step
  for (int step = 0; step < 9; ++step) {
    // In every third step nothing moves, and the contacts are those of the step before.
    if (step % 3 != 2) {
      for (Scene* const scene : {&plain, &*keeping})
        scene->set_motion(scene->objects()[1], moved, ball.positions);
    }
    for (Vec3d& p : moved) p = p + Vec3d{0.02, 0.1, 0};
    const DetectResult& wanted = plain.detect();
    const DetectResult& found = keeping->detect();
    EXPECT_EQ(found.step, wanted.step);
    for_each_list([&](const auto& list, auto member) {
      EXPECT_TRUE(std::ranges::equal(member(found), member(wanted))) << list.name << " of step " << step;
    });
    EXPECT_TRUE(std::ranges::equal(found.contact_events.stay, wanted.contact_events.stay));
    EXPECT_TRUE(std::ranges::equal(found.ended_manifolds, wanted.ended_manifolds));
    EXPECT_TRUE(verify(*keeping).agrees());
    held.hold(found);
    kept.push_back(keeping->keep_result());
    EXPECT_TRUE(keeping->result().contacts.empty());
    EXPECT_THROW(verify(*keeping), Error);
  }
  keeping.reset();
  EXPECT_GT(held.check("the end of the scene"), 100u);
}

INSTANTIATE_TEST_SUITE_P(Listings, ResultSpans,
                         testing::Values(ContinuousListing::all, ContinuousListing::first),
                         [](const auto& listing) {
                           return listing.param == ContinuousListing::all ? "All" : "First";
                         });

}  // namespace supple::result_spans_test
