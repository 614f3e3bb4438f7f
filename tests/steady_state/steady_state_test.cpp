// Ten thousand steps of nine built-in objects that deform and collide. After one period of their motion no
// step allocates memory, and the octrees stay valid.

#include <gtest/gtest.h>
#include <malloc.h>

#include <cctype>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "allocation_count.hpp"
#include "supple/broad_phase.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/trigonometry.hpp"
#include "support/option_word.hpp"

namespace supple {
namespace {

/// An object that circles the origin and wobbles. The motion repeats after `period` steps.
struct Wobbling {
  static constexpr int period = 1000;

  TriangleMesh rest;
  ObjectId id;
  double phase = 0;
  std::vector<Vec3d> now;

  void move_to(int step) {
    const double turns = static_cast<double>(step % period) / period;
    const Vec3d centre{0.45 * cos_turns(phase + turns), 0.3 * sin_turns(phase + 2 * turns),
                       0.45 * sin_turns(3 * phase + turns)};
    for (std::size_t v = 0; v < now.size(); ++v) {
      const Vec3d p = rest.positions[v];
      now[v] = centre + p * (1 + 0.08 * sin_turns(2 * p.x + p.y + 5 * turns + phase));
    }
  }
};

struct Configuration {
  const char* name;
  BoundingVolume bounding_volume;
  BroadPhaseMethod broad_phase;
  int steps_when_optimised;
};
/// GoogleTest calls this function; ctest shows the name.
void PrintTo(const Configuration& configuration, std::ostream* out) {
  *out << configuration.name;
}

class SteadyState : public testing::TestWithParam<Configuration> {};

TEST_P(SteadyState, NoAllocationsAfterWarmUpAndValidOctreesThroughout) {
  const auto [name, bounding_volume, broad_phase, steps_when_optimised] = GetParam();
#ifdef NDEBUG
  const int steps = steps_when_optimised, validate_every = 1;
#else
  const int steps = 1200, validate_every = 100;
#endif
  constexpr int warm_up = Wobbling::period;
  Scene scene({.bounding_volume = bounding_volume, .broad_phase = broad_phase, .threads = 1});
  std::vector<Wobbling> objects(9);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    constexpr std::string_view names[] = {"pawn", "fish", "rabbit"};
    objects[i].rest = make_model(names[i % 3]);
    objects[i].id = scene.add(objects[i].rest);
    objects[i].phase = static_cast<double>(i) / 9;
    objects[i].now = objects[i].rest.positions;
  }
  std::uint64_t contacts = 0, allocated_in_steps = 0;
  [[maybe_unused]] std::size_t heap_after_warm_up = 0;  // sanitizers replace malloc
  for (int step = 0; step < steps; ++step) {
    for (Wobbling& object : objects) object.move_to(step);
    const std::uint64_t before = allocation_count();
    for (const Wobbling& object : objects) scene.set_positions(object.id, object.now);
    contacts += scene.detect().contacts.size();
    if (step >= warm_up) allocated_in_steps += allocation_count() - before;
    if (step == warm_up) heap_after_warm_up = mallinfo2().uordblks;
    if (step % validate_every == 0) {
      ASSERT_EQ(SceneInspector(scene).validate(), "") << "step " << step;
    }
  }
  EXPECT_EQ(allocated_in_steps, 0u);
  EXPECT_GT(contacts, static_cast<std::uint64_t>(steps));
#if !defined(SUPPLE_SANITIZED)
  EXPECT_LE(mallinfo2().uordblks, heap_after_warm_up + 4096) << "the heap grew";
#endif
}

INSTANTIATE_TEST_SUITE_P(
    Configurations, SteadyState,
    testing::Values(Configuration{"BoxesAutomatic", BoundingVolume::aabb, BroadPhaseMethod::automatic, 10000},
                    Configuration{"BoxesGrid", BoundingVolume::aabb, BroadPhaseMethod::grid, 2000},
                    Configuration{"BoxesOctree", BoundingVolume::aabb, BroadPhaseMethod::octree, 2000},
                    Configuration{"BoxesSweep", BoundingVolume::aabb, BroadPhaseMethod::sweep, 2000},
                    Configuration{"BoxesSweep3", BoundingVolume::aabb, BroadPhaseMethod::sweep3, 2000},
                    Configuration{"SpheresOctree", BoundingVolume::sphere, BroadPhaseMethod::octree, 2000}),
    [](const auto& configuration) { return configuration.param.name; });

#if !defined(SUPPLE_SANITIZED)
/// Assemblies have 100,000 small parts.
TEST(SteadyStateMemory, SmallObjectsTakeLittleMemory) {
  constexpr int parts = 1000;
  SceneOptions options;
  options.threads = 1;
  const std::size_t at_first = mallinfo2().uordblks;
  Scene scene(options);
  EXPECT_LE(mallinfo2().uordblks - at_first, 20000u);
  TriangleMesh part{"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const std::size_t before = mallinfo2().uordblks;
  for (int i = 0; i < parts; ++i) {
    for (Vec3d& position : part.positions) position.x += 3;
    scene.add(part);
  }
  EXPECT_LE((mallinfo2().uordblks - before) / parts, 1950u);
  scene.detect();
  EXPECT_LE((mallinfo2().uordblks - before) / parts, 2300u);
}
#endif

/// A cloth that folds, within its margin of itself.
TEST(SteadyStateProximity, NoAllocationsAfterWarmUp) {
  constexpr int period = 12, steps = 5 * period;
  const TriangleMesh cloth = make_cloth(32, 32);
  // Points where edges go through faces need integers of any size, too, so these pairs are left out.
  for (const auto& [listing, kinds] : {std::pair(ProximityListing::features, ElementKinds::vertex_face),
                                       {ProximityListing::features, ElementKinds::edge_edge},
                                       {ProximityListing::elements, ElementKinds::vertex_face},
                                       {ProximityListing::elements, ElementKinds::edge_edge}}) {
    SceneOptions options;
    options.contacts = ContactKinds::proximity;
    options.proximity_listing = listing;
    options.element_kinds = kinds;
    options.manifolds = true;
    options.threads = 1;
    Scene scene(options);
    const ObjectId id = scene.add(cloth, {.self_collision = true, .margin = 0.02});
    std::vector<Vec3d> positions = cloth.positions;
    std::uint64_t pairs = 0, allocated_in_steps = 0;
    for (int step = 0; step < steps; ++step) {
      const double turns = static_cast<double>(step % period) / period;
      for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3d p = cloth.positions[v];
        const double fold = sin_turns(2 * p.x + turns);
        // No two edges are parallel: these would need integers of any size, which are not on the stack.
        const auto ripple = [&](double part) { return 1e-3 * sin_turns(part * static_cast<double>(v)); };
        positions[v] = {0.25 * p.x + 0.13 * fold + ripple(0.123),
                        0.2 * sin_turns(1.3 * p.x + 0.37 * p.z + turns) + ripple(0.377), p.z + ripple(0.719)};
      }
      const std::uint64_t before = allocation_count();
      scene.set_positions(id, positions);
      pairs += scene.detect().proximity_pairs.size();
      if (step >= 2 * period) allocated_in_steps += allocation_count() - before;
    }
    EXPECT_EQ(allocated_in_steps, 0u);
    EXPECT_GT(pairs, 2'000u);
  }
}

/// Boxes of three kinds that drift; in some steps only a few move, or change their kind.
TEST(SteadyStateKinds, NoAllocationsAfterWarmUp) {
  constexpr int period = 24, steps = 4 * period;
  for (const BroadPhaseMethod method :
       {BroadPhaseMethod::automatic, BroadPhaseMethod::octree, BroadPhaseMethod::grid,
        BroadPhaseMethod::sweep, BroadPhaseMethod::sweep3}) {
    BroadPhaseOptions options;
    options.method = method;
    options.threads = 1;
    options.kind_pairs = {{0, 2}, {1, 1}};
    BroadPhase broad_phase(options);
    std::vector<Aabb> boxes(3000);
    std::vector<std::uint8_t> kinds(boxes.size());
    std::uint64_t pairs = 0, allocated_in_steps = 0;
    for (int step = 0; step < steps; ++step) {
      const int turn = step % period;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (turn > period / 2 && i % 50 != 0) continue;
        const auto place = [&](double part) {
          return static_cast<float>(10 * sin_turns(part * static_cast<double>(i) + 0.01 * turn));
        };
        const Vec3f low{place(0.123), place(0.377), place(0.719)};
        boxes[i] = {low, low + Vec3f{0.8f, 0.8f, 0.8f}};
        kinds[i] = static_cast<std::uint8_t>((i + static_cast<std::size_t>(turn) / 3) % 3);
      }
      const std::uint64_t before = allocation_count();
      pairs += broad_phase.find_object_pairs(boxes, kinds).size();
      if (step >= 2 * period) allocated_in_steps += allocation_count() - before;
    }
    EXPECT_EQ(allocated_in_steps, 0u) << static_cast<int>(method);
    EXPECT_GT(pairs, 2'000u);
  }
}

/// Continuous contacts of a cloth with itself and with a ball; both move on paths.
TEST(SteadyStateContinuous, NoAllocationsAfterWarmUp) {
#ifdef NDEBUG
  constexpr int steps = 240;
#else
  constexpr int steps = 48;
#endif
  constexpr int period = 12;
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  options.threads = 1;
  Scene scene(options);
  const TriangleMesh cloth_mesh = make_cloth(24, 24), ball_mesh = make_icosphere(6);
  const ObjectId cloth = scene.add(cloth_mesh, {.self_collision = true}), ball = scene.add(ball_mesh);
  std::vector<Vec3d> cloth_from(cloth_mesh.positions.size()), cloth_to = cloth_from;
  std::vector<Vec3d> ball_from(ball_mesh.positions.size()), ball_to = ball_from;
  const auto place = [&](int step, std::vector<Vec3d>& of_cloth, std::vector<Vec3d>& of_ball) {
    const double turns = static_cast<double>(step % period) / period;
    for (std::size_t v = 0; v < of_cloth.size(); ++v) {
      const Vec3d p = cloth_mesh.positions[v];
      const double fold = sin_turns(2 * p.x + turns);
      // The vertices are not collinear: repeated roots would need the widest integers, which are not on the
      // stack.
      const double bend = sin_turns(1.7 * p.x + 2.3 * p.z + turns),
                   other = sin_turns(p.x - 3.1 * p.z - turns);
      of_cloth[v] = {0.4 * p.x + 0.1 * fold + 0.02 * bend, 0.2 * fold * sin_turns(2 * p.z) + 0.01 * other,
                     p.z + 0.02 * other - 0.01 * bend};
    }
    for (std::size_t v = 0; v < of_ball.size(); ++v)
      of_ball[v] =
          ball_mesh.positions[v] * (0.15 + 0.01 * turns) + Vec3d{0.01 * turns, 0.3 * sin_turns(turns), 0.1};
  };
  std::uint64_t contacts = 0, allocated_in_steps = 0;
  for (int step = 0; step < steps; ++step) {
    place(step, cloth_from, ball_from);
    place(step + 1, cloth_to, ball_to);
    const std::uint64_t before = allocation_count();
    scene.set_motion(cloth, cloth_from, cloth_to);
    scene.set_motion(ball, ball_from, ball_to);
    contacts += scene.earliest_impact().has_value() ? 1 : 0;
    contacts += scene.detect().continuous_contacts.size();
    if (step >= 2 * period) allocated_in_steps += allocation_count() - before;
    ASSERT_EQ(SceneInspector(scene).validate(), "") << "step " << step;
  }
  EXPECT_EQ(allocated_in_steps, 0u);
  EXPECT_GT(contacts, static_cast<std::uint64_t>(steps));
}

/// Balls that move in every supported way, with a periodic motion.
class MovingBalls {
 public:
  static constexpr int period = 20;

  MovingBalls(ContactKinds contacts, std::uint32_t threads)
      : scene_({.contacts = contacts,
                .manifolds = contains(contacts, ContactKinds::penetration),
                .threads = threads}),
        has_limit_(!contains(contacts, ContactKinds::penetration)) {
    for (std::size_t i = 0; i < 8; ++i) {
      const TriangleMesh ball = uneven_ball(i);
      ids_.push_back(scene_.add(ball, {.self_collision = i == 0, .solid = true}));
      scene_.set_positions(ids_[i], ball.positions);
      scene_.translate(ids_[i], center(i));
    }
  }
  /// Returns the number of allocations.
  std::uint64_t step(int step) {
    const double turns = static_cast<double>(step % period) / period;
    for (std::size_t v = 0; v < from_.size(); ++v) {
      from_[v] = ball_.positions[v] * (1 + 0.1 * sin_turns(2 * ball_.positions[v].x + turns)) + center(2);
      to_[v] = from_[v] + Vec3d{0.05, 0.1 * cos_turns(turns), 0};
    }
    const std::uint64_t before = allocation_count();
    // Forwards and back, so the sum of the offsets repeats after each period.
    scene_.translate(ids_[0], {step % 2 == 0 ? 0.25 : -0.25, 0, 0});
    scene_.set_transform(ids_[1], {.rotation = {cos_turns(turns), 0, sin_turns(turns), 0, 1, 0,
                                                -sin_turns(turns), 0, cos_turns(turns)},
                                   .translation = center(1)});
    scene_.set_transform(ids_[4], {.translation = center(4) + Vec3d{0, 0.25 * sin_turns(turns), 0}});
    scene_.set_motion(ids_[2], from_, to_);
    scene_.set_positions(ids_[3], from_);
    scene_.translate(ids_[3], {0.5, 0, 0});
    const DetectResult& result = scene_.detect();
    contacts_ += result.contacts.size() + result.continuous_contacts.size() + result.penetrations.size();
    if (has_limit_) contacts_ += scene_.detect({.max_contacts = 50}).contacts.size();
    ask();
    return allocation_count() - before;
  }
  std::uint64_t contacts() const { return contacts_; }

 private:
  void ask() {
    scene_.closest(points_, closest_);
    scene_.inside(points_, places_);
    for (std::size_t i = 0; i < rays_.size(); ++i) rays_[i].origin = points_[i];
    scene_.cast(rays_, hits_);
    contacts_ += scene_.any_contact(ids_[0], ids_[1]) ? 1 : 0;
  }
  static Vec3d center(std::size_t i) {
    return {1.7 * static_cast<double>(i & 1), 1.7 * static_cast<double>(i >> 1 & 1),
            1.7 * static_cast<double>(i >> 2)};
  }

  Scene scene_;
  bool has_limit_;
  /// No two are alike: features at equal distances and parallel edges need integers of unlimited size, which
  /// allocate memory.
  static TriangleMesh uneven_ball(std::size_t number) {
    TriangleMesh ball = make_icosphere(6);
    const double turns = 0.13 * static_cast<double>(number);
    for (Vec3d& p : ball.positions)
      p = p * (1 + 0.05 * sin_turns(1.3 * p.x + 0.7 * p.y + turns) + 0.04 * sin_turns(0.9 * p.z - 0.6 * p.x));
    return ball;
  }

  TriangleMesh ball_ = uneven_ball(9);
  std::vector<Vec3d> points_{{0.1, 0.2, 0.3}, {1.7, 0.1, -0.2}, {3, 3, 3}, {1.5, 1.6, 0.4}};
  std::vector<Ray> rays_ = std::vector<Ray>(points_.size(), Ray{{}, {0.3, 1, -0.2}});
  std::vector<std::optional<ClosestPoint>> closest_ =
      std::vector<std::optional<ClosestPoint>>(points_.size());
  std::vector<std::optional<RayHit>> hits_ = std::vector<std::optional<RayHit>>(points_.size());
  std::vector<Containment> places_ = std::vector<Containment>(points_.size());
  std::vector<ObjectId> ids_;
  std::vector<Vec3d> from_ = ball_.positions, to_ = from_;
  std::uint64_t contacts_ = 0;
};

class SteadyStateMoves : public testing::TestWithParam<OptionWord<ContactKinds>> {};

TEST_P(SteadyStateMoves, NoAllocationsAfterWarmUp) {
  MovingBalls balls(GetParam(), 1);
  std::uint64_t allocations = 0;
  for (int step = 0; step < 6 * MovingBalls::period; ++step) {
    const std::uint64_t in_step = balls.step(step);
    if (step >= 3 * MovingBalls::period) allocations += in_step;
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(balls.contacts(), 1000u);
}

/// The distribution of tasks differs between steps: a worker's lists may still grow after the first steps,
/// several of them in one step that gives this worker more tasks than before. Each growth doubles the
/// capacity, so steps with allocations become rare.
TEST_P(SteadyStateMoves, HardlyAnyAllocationsWithThreads) {
  MovingBalls balls(GetParam(), 3);
  int allocating_steps = 0;
  constexpr int counted = 8 * MovingBalls::period;
  for (int step = 0; step < 2 * counted; ++step) {
    const std::uint64_t in_step = balls.step(step);
    if (step >= counted && in_step != 0) ++allocating_steps;
  }
  EXPECT_LT(allocating_steps, counted / 5);
}

std::string name_of_kinds(const testing::TestParamInfo<OptionWord<ContactKinds>>& kinds) {
  std::string name = word_of(kinds.param.value);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name.find(',') == std::string::npos ? name : "Both";
}

INSTANTIATE_TEST_SUITE_P(Kinds, SteadyStateMoves,
                         testing::Values(ContactKinds::intersection, ContactKinds::continuous,
                                         ContactKinds::intersection | ContactKinds::continuous,
                                         ContactKinds::penetration),
                         name_of_kinds);

}  // namespace
}  // namespace supple
