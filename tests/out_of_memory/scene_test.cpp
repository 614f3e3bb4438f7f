// A scene in which one allocation fails stays usable: the call that failed can be repeated, and then all
// results and events are those of a scene that never ran out of memory.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "every_allocation.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/soups.hpp"

namespace supple::scene_test {

/// The numbers of results, so that those of two scenes can be compared.
class Digest {
 public:
  template <class Item>
  void add(std::span<const Item> items) {
    add_number(static_cast<double>(items.size()));
    for (const Item& item : items) add_item(item);
  }
  void add(const PairEvents& events) {
    add(events.begin);
    add(events.stay);
    add(events.end);
  }
  void add(const DetectResult& result) {
    add_number(static_cast<double>(result.step));
    add_number(result.truncated);
    add_number(result.stopped);
    add(result.object_pairs);
    add(result.contacts);
    add(result.contact_points);
    add(result.continuous_contacts);
    add(result.proximity_pairs);
    add(result.penetrations);
    add(result.vertices_on_surface);
    add(result.contained_parts);
    add(result.curves);
    add(result.curve_contacts);
    add(result.curve_points);
    add(result.enclosed_vertices);
    add(result.colliding_vertices);
    add(result.non_finite_vertices);
    for (const PairEvents& events : {result.volume_events, result.narrow_phase_events, result.contact_events,
                                     result.proximity_events, result.penetration_events})
      add(events);
  }
  void add_number(double number) { numbers_.push_back(number == number ? number : -12345); }
  const std::vector<double>& numbers() const { return numbers_; }

 private:
  void add_item(ObjectId id) {
    add_number(id.index);
    add_number(id.generation);
  }
  void add_item(const ObjectPair& pair) {
    add_item(pair.a);
    add_item(pair.b);
  }
  void add_item(const Vec3d& p) {
    for (int axis = 0; axis < 3; ++axis) add_number(p[axis]);
  }
  void add_item(std::uint32_t id) { add_number(id); }
  void add_item(const Contact& c) {
    for (const std::uint32_t id : {c.object_a.index, c.triangle_a, c.object_b.index, c.triangle_b,
                                   std::uint32_t(c.kind), c.first_point, std::uint32_t(c.point_count)})
      add_number(id);
    add_item(Vec3d(c.normal));
  }
  void add_item(const ContactPoint& point) { add_item(point.position); }
  void add_item(const ContinuousContact& c) {
    for (const std::uint32_t id :
         {c.object_a.index, c.element_a[0], c.object_b.index, c.element_b[0], std::uint32_t(c.kind)})
      add_number(id);
    add_number(c.toi);
    add_item(c.normal);
  }
  void add_item(const ProximityPair& p) {
    for (const std::uint32_t id : {p.object_a.index, p.element_a[0], p.object_b.index, p.element_b[0],
                                   std::uint32_t(p.kind_a), std::uint32_t(p.kind_b)})
      add_number(id);
    add_number(p.distance);
    add_item(p.normal);
  }
  void add_item(const Penetration& p) {
    add_number(p.vertex);
    add_number(p.depth);
  }
  void add_item(const ContainedPart& part) {
    add_item(part.inner);
    add_item(part.outer);
    add_number(part.vertex);
  }
  void add_item(const IntersectionCurve& curve) {
    add_item(curve.a);
    add_item(curve.b);
    add_number(curve.contact_count);
    add_item(curve.area);
    add_number(curve.depth);
  }
  void add_item(const NonFiniteVertex& vertex) {
    add_item(vertex.object);
    add_number(vertex.vertex);
  }

  std::vector<double> numbers_;
};

TriangleMesh ball(Vec3d at) {
  TriangleMesh mesh = make_icosphere(2);
  for (Vec3d& p : mesh.positions) p = p + at;
  return mesh;
}

std::vector<Vec3d> moved(std::vector<Vec3d> positions, Vec3d by) {
  for (Vec3d& p : positions) p = p + by;
  return positions;
}

/// What a user keeps next to a scene, and the log of its results.
struct World {
  explicit World(const SceneOptions& options) : scene(options) {}

  Scene scene;
  std::vector<ObjectId> ids = std::vector<ObjectId>(6);
  std::vector<Vec3d> positions = ball({}).positions;
  std::vector<float> floats = std::vector<float>(3 * positions.size(), 0.25f);
  std::vector<double> log;  // of complete calls

  void detect(const DetectRequest& request = {}) { log_result(scene.detect(request)); }
  void log_result(const DetectResult& result) {
    const std::int64_t left = allow_allocations();  // those of the digest are not part of the life
    Digest digest;
    digest.add(result);
    log.insert(log.end(), digest.numbers().begin(), digest.numbers().end());
    refuse_allocation(left);
  }
};

/// One call of the user. It changes nothing but the scene before it is complete.
using Call = std::function<void(World&)>;

constexpr ContactKinds all_kinds = ContactKinds::intersection | ContactKinds::continuous |
                                   ContactKinds::proximity | ContactKinds::penetration;

std::vector<Call> adding() {
  const auto add = [](std::size_t i, TriangleMesh mesh, ObjectOptions options = {}) -> Call {
    return [=](World& world) { world.ids[i] = world.scene.add(mesh, options); };
  };
  return {add(0, ball({}), {.margin = 0.1, .solid = true}),
          add(1, ball({1.2, 0, 0}), {.margin = 0.1, .solid = true}),
          add(2, crumpled_sheet(4, 4, 0.1, 3), {.self_collision = true, .margin = 0.02}),
          add(3, ball({0.1, 5, 0}), {.is_static = true}),
          [](World& world) { world.detect(); },
          [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); }};
}

std::vector<Call> moving() {
  return {
      [](World& world) {
        world.scene.set_positions(world.ids[0], moved(world.positions, {0.3, 0.1, 0}));
      },
      [](World& world) {
        world.scene.translate(world.ids[1], {0.1, 4.3, 0});
      },
      [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); },
      [](World& world) {
        world.scene.set_transform(world.ids[1], {{0, 1, 0, -1, 0, 0, 0, 0, 1}, {1, 0, 0}});
      },
      [](World& world) { world.detect(); },
      [](World& world) {
        world.scene.set_motion(world.ids[0], world.positions, moved(world.positions, {1.5, 0, 0}));
      },
      [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); },
      [](World& world) { world.log.push_back(world.scene.max_step().step); },
      [](World& world) { world.log.push_back(world.scene.collision_free_step().step); },
      [](World& world) {
        for (const ObjectStep& found : world.scene.collision_free_steps())
          world.log.push_back(found.safe.step);
      },
      [](World& world) { world.scene.set_positions(world.ids[0], PositionsView(world.floats)); },
      [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); },
      [](World& world) { world.scene.share_positions(world.ids[0], world.positions); },
      [](World& world) { world.detect(); },
      [](World& world) {
        const std::array<std::uint32_t, 2> vertices{3, 4};
        const std::array<Vec3d, 2> to{{{0.5, 0.5, 0.5}, {9, 9, std::numeric_limits<double>::quiet_NaN()}}};
        world.scene.set_vertices(world.ids[0], vertices, std::span<const Vec3d>(to));
      },
      [](World& world) { world.detect(); },
      [](World& world) {
        const std::array<std::uint32_t, 1> vertices{4};
        const std::array<Vec3d, 1> to{{{1, 1, 1}}};
        world.scene.set_vertices(world.ids[0], vertices, std::span<const Vec3d>(to));
      },
      [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); },
      [](World& world) {
        world.scene.translate(world.ids[1], {0, 1e31, 0});
      },
      [](World& world) { world.detect(); },
      [](World& world) {
        world.scene.set_transform(world.ids[1], {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0}});
      },
      [](World& world) { world.detect(); },
  };
}

std::vector<Call> removing() {
  return {
      [](World& world) { world.scene.remove(world.ids[1]); },
      [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); },
      [](World& world) {
        world.ids[1] = world.scene.add(ball({0.5, 0, 0}), {.solid = true});
      },
      [](World& world) {
        world.ids[4] = world.scene.add(ball({0, 0.5, 0}), {});
      },
      [](World& world) { world.scene.remove(world.ids[0]); },
      [](World& world) { world.scene.remove(world.ids[2]); },
      [](World& world) { world.detect(); },
      [](World& world) {
        world.scene.set_vertex_groups(world.ids[4], std::vector<std::uint32_t>(42, 1),
                                      std::vector<std::uint32_t>(42, 2));
      },
      [](World& world) { world.detect(); },
      [](World& world) {
        world.scene.edit(world.ids[4], {.removed = std::vector<std::uint32_t>{3, 1},
                                        .added = std::vector<Triangle>{{0, 1, 42}, {5, 42, 9}},
                                        .new_vertices = std::vector<Vec3d>{{0.5, 0.5, 0}}});
      },
      [](World& world) { world.detect(); },
      [](World& world) { world.scene.set_vertex_groups(world.ids[4], {}, {}); },
      [](World& world) {
        world.scene.edit(world.ids[1], {.removed = std::vector<std::uint32_t>{2},
                                        .added_edges = std::vector<std::array<std::uint32_t, 2>>{{0, 7}},
                                        .added_points = std::vector<std::uint32_t>{1}});
      },
      [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); },
      [](World& world) {
        for (const std::uint32_t number : world.scene.compact(world.ids[4])) world.log.push_back(number);
      },
      [](World& world) { world.detect({.contacts = all_kinds, .curves = true}); },
  };
}

std::vector<Call> asking() {
  const auto points = [] {
    std::vector<Vec3d> all;
    RandomNumbers random(5);
    for (int i = 0; i < 40; ++i) all.push_back(random.vector(1.5));
    return all;
  }();
  std::vector<Ray> rays;
  for (const Vec3d& p : points) rays.push_back({p, {1, 0.1, 0.2}});
  return {
      [=](World& world) {
        std::vector<std::optional<ClosestPoint>> found(points.size());
        world.scene.closest(points, found);
        for (const auto& answer : found) world.log.push_back(answer ? answer->distance : -1);
      },
      [=](World& world) {
        std::vector<Containment> found(points.size());
        world.scene.inside(points, found, {.object = world.ids[0]});
        for (const Containment answer : found) world.log.push_back(static_cast<double>(answer));
      },
      [=](World& world) {
        const auto hits = world.scene.cast_all(rays);
        world.log.push_back(static_cast<double>(hits.size()));
      },
      [=](World& world) {
        const std::array<QueryBox, 1> boxes{{{{-1, -1, -1}, {0.3, 0.3, 0.3}}}};
        world.log.push_back(static_cast<double>(world.scene.overlaps(boxes).size()));
      },
      [](World& world) {
        const auto pair = world.scene.distance(world.ids[0], world.ids[3]);
        world.log.push_back(pair ? pair->distance : -1);
      },
      [](World& world) {
        for (const ProximityPair& pair : world.scene.distances(10)) world.log.push_back(pair.distance);
      },
      [](World& world) { world.log.push_back(world.scene.any_contact(world.ids[0], world.ids[1])); },
      [](World& world) { world.log_result(world.scene.search({.contacts = all_kinds})); },
      [](World& world) {
        world.log_result(world.scene.search({}, [](ObjectId a, ObjectId) { return a.index != 2; }));
      },
      [](World& world) {
        const auto first = world.scene.earliest_impact();
        world.log.push_back(first ? first->toi : -1);
      },
      [=](World& world) {
        std::vector<std::optional<RayHit>> hits(rays.size());
        world.scene.cast(rays, hits);
        for (const auto& hit : hits) world.log.push_back(hit ? hit->t : -1);
      },
      [](World& world) {
        const std::array<QuerySphere, 1> spheres{{{{0.5, 0, 0}, 0.4}}};
        world.log.push_back(static_cast<double>(world.scene.overlaps(spheres).size()));
      },
      [](World& world) { world.detect(); },
  };
}

/// Touching boxes that part, so that steps decide the triangles around the points that they share.
std::vector<Call> parting() {
  const auto box = [](Vec3d at) {
    TriangleMesh mesh = make_box({1, 1, 1}, 1);
    for (Vec3d& p : mesh.positions) p = p + at;
    return mesh;
  };
  const TriangleMesh above = box({0.25, 1, 0});
  return {
      [=](World& world) { world.ids[5] = world.scene.add(box({}), {}); },
      [=](World& world) { world.ids[2] = world.scene.add(above, {}); },
      [=](World& world) {
        world.scene.set_motion(world.ids[2], above.positions, moved(above.positions, {0, 1, 0}));
      },
      [](World& world) { world.log.push_back(world.scene.max_step().step); },
      [](World& world) { world.log.push_back(world.scene.collision_free_step().step); },
      [](World& world) {
        for (const ObjectStep& found : world.scene.collision_free_steps())
          world.log.push_back(found.safe.step);
      },
      [](World& world) { world.detect({.contacts = all_kinds}); },
  };
}

/// A filter that takes memory. What an observer throws leaves a call that is complete.
std::vector<Call> filtering() {
  return {
      [](World& world) {
        world.scene.set_pair_filter([](ObjectId a, ObjectId b) {
          const std::vector<std::uint32_t> both{a.index, b.index};
          return both[0] + both[1] != 4;
        });
      },
      [](World& world) { world.detect(); },
      [](World& world) { world.log_result(world.scene.search({.contacts = all_kinds})); },
      [](World& world) { world.log.push_back(world.scene.collision_free_step().step); },
      [](World& world) { world.scene.set_pair_filter({}); },
  };
}

std::vector<Call> joined(std::initializer_list<std::vector<Call>> parts) {
  std::vector<Call> all;
  for (const std::vector<Call>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::optional<World> made_world(const SceneOptions& options, Refusal& refusal) {
  std::optional<World> world;
  refusal.repeat([&] { world.emplace(options); });
  return world;
}

/// Expects that a life in which one call fails and is repeated has the same results as one without failure.
void expect_usable_scene(const SceneOptions& options, const std::vector<Call>& calls) {
  World undisturbed(options);
  for (const Call& call : calls) call(undisturbed);
  ASSERT_GT(undisturbed.log.size(), 100u);
  const auto life = [&](Refusal& refusal) {
    std::optional<World> world = made_world(options, refusal);
    for (const Call& call : calls) {
      const std::size_t known = world->log.size();
      if (!refusal.strikes([&] { call(*world); })) continue;
      SCOPED_TRACE("call " + std::to_string(&call - calls.data()));
      world->log.resize(known);
      EXPECT_EQ(SceneInspector(world->scene).validate(), "");
      call(*world);
    }
    EXPECT_EQ(SceneInspector(world->scene).validate(), "");
    EXPECT_TRUE(world->log == undisturbed.log)
        << "the logs of " << world->log.size() << " and " << undisturbed.log.size() << " numbers differ at "
        << std::mismatch(world->log.begin(), world->log.end(), undisturbed.log.begin(), undisturbed.log.end())
                   .first -
               world->log.begin();
  };
  // Worker threads keep memory until the program ends.
  refuse_every_allocation(life, options.threads == 1);
}

TEST(SceneOutOfMemory, ACallThatFailedCanBeRepeated) {
  expect_usable_scene({.threads = 1}, joined({adding(), moving(), asking(), removing()}));
}

TEST(SceneOutOfMemory, WithTwoThreads) {
  expect_usable_scene({.threads = 2}, joined({adding(), moving(), asking(), removing()}));
}

TEST(SceneOutOfMemory, WhereObjectsTouchAndAFilterIsCalled) {
  for (const std::uint32_t threads : {1u, 2u}) {
    SCOPED_TRACE(threads);
    expect_usable_scene({.threads = threads}, joined({parting(), filtering(), adding(), filtering()}));
  }
}

TEST(SceneOutOfMemory, WithEveryBroadPhase) {
  for (const BroadPhaseMethod method :
       {BroadPhaseMethod::octree, BroadPhaseMethod::grid, BroadPhaseMethod::sweep, BroadPhaseMethod::brute,
        BroadPhaseMethod::sweep3}) {
    SCOPED_TRACE(static_cast<int>(method));
    expect_usable_scene({.broad_phase = method, .threads = 1}, joined({adding(), moving(), removing()}));
  }
}

TEST(SceneOutOfMemory, WithSpheresAndSeveralThreads) {
  expect_usable_scene(
      {.bounding_volume = BoundingVolume::sphere, .broad_phase = BroadPhaseMethod::octree, .threads = 3},
      joined({adding(), moving(), removing()}));
}

/// A change that fails has no effect: the object stays where it was.
TEST(SceneOutOfMemory, AFailedChangeHasNoEffect) {
  std::vector<Call> calls = joined({adding(), moving(), removing()});
  const auto state = [](World& world) {
    std::vector<double> numbers;
    for (const ObjectId id : world.scene.objects()) {
      numbers.push_back(id.index);
      for (std::uint32_t v = 0; v < world.scene.vertex_count(id); ++v) {
        const Vec3d p = world.scene.position(id, v);
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(p[axis] == p[axis] ? p[axis] : -12345);
      }
    }
    return numbers;
  };
  refuse_every_allocation([&](Refusal& refusal) {
    std::optional<World> world = made_world({.threads = 1}, refusal);
    for (const Call& call : calls) {
      const std::vector<double> before = state(*world);
      if (!refusal.strikes([&] { call(*world); })) continue;
      SCOPED_TRACE("call " + std::to_string(&call - calls.data()));
      EXPECT_EQ(state(*world), before);
      world->scene.detect();
      EXPECT_EQ(SceneInspector(world->scene).validate(), "");
      EXPECT_TRUE(verify(world->scene).agrees());
      call(*world);
    }
  });
}

}  // namespace supple::scene_test
