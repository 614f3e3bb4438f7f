// A distributed scene equals one `Scene` on one rank: random lives of scenes whose objects are on different
// ranks or in parts, appear, vanish, change their rank, crowd into a corner, and have broken coordinates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "supple/distributed.hpp"
#include "supple/models.hpp"
#include "supple/result_lists.hpp"
#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple {
namespace {

int rank_of_world() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}
int size_of_world() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// An object of both scenes. All ranks know all of them.
struct LivingObject {
  ObjectId id;
  TriangleMesh mesh;
  ObjectOptions options;
  bool is_float = false;
  std::vector<int> rank_of_triangle;  // of an object in parts; else empty
  int home = 0;
  Vec3d place;
  std::vector<Vec3d> now, from;
  bool is_on_path = false;
};

/// The vertices and triangles of a part.
struct Part {
  std::vector<std::uint32_t> vertices, triangles;
  std::vector<Triangle> corners;
};

Part part_of(const LivingObject& object, int rank) {
  Part part;
  for (std::uint32_t t = 0; t < object.mesh.triangles.size(); ++t) {
    if (object.rank_of_triangle[t] != rank) continue;
    part.triangles.push_back(t);
    for (const std::uint32_t v : object.mesh.triangles[t]) part.vertices.push_back(v);
  }
  std::sort(part.vertices.begin(), part.vertices.end());
  part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
  for (const std::uint32_t t : part.triangles) {
    Triangle corners = object.mesh.triangles[t];
    for (std::uint32_t& corner : corners) {
      corner = static_cast<std::uint32_t>(
          std::lower_bound(part.vertices.begin(), part.vertices.end(), corner) - part.vertices.begin());
    }
    part.corners.push_back(corners);
  }
  return part;
}

template <class Scalar>
std::vector<Vec3<Scalar>> chosen(const std::vector<Vec3d>& positions,
                                 const std::vector<std::uint32_t>* some) {
  std::vector<Vec3<Scalar>> found;
  const auto add = [&](const Vec3d& p) {
    found.push_back({static_cast<Scalar>(p.x), static_cast<Scalar>(p.y), static_cast<Scalar>(p.z)});
  };
  if (some == nullptr) {
    for (const Vec3d& p : positions) add(p);
  } else {
    for (const std::uint32_t v : *some) add(positions[v]);
  }
  return found;
}

/// Calls `use(view)` with views of positions in the object's precision.
template <class Use, class... Lists>
void with_views(bool is_float, const std::vector<std::uint32_t>* some, const Use& use,
                const Lists&... lists) {
  if (is_float) {
    use(PositionsView(chosen<float>(lists, some))...);
  } else {
    use(PositionsView(chosen<double>(lists, some))...);
  }
}

/// Equality of records, in which a NaN equals itself.
bool same_number(double p, double q) {
  return p == q || (p != p && q != q);
}
template <class Row>
bool same_row(const Row& p, const Row& q) {
  if constexpr (std::is_same_v<Row, NonFiniteVertex>) {
    return p.object == q.object && p.vertex == q.vertex && same_number(p.position.x, q.position.x) &&
           same_number(p.position.y, q.position.y) && same_number(p.position.z, q.position.z);
  } else {
    return p == q;
  }
}
bool same_row(const ContactGroup& p, const ContactGroup& q) {
  return p.a == q.a && p.b == q.b && p.first_contact == q.first_contact && p.contact_count == q.contact_count;
}

template <class Row>
void expect_same(const char* name, std::span<const Row> found, std::span<const Row> expected,
                 const std::string& where) {
  ASSERT_EQ(found.size(), expected.size()) << name << " " << where;
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_TRUE(same_row(found[i], expected[i])) << name << " " << i << " " << where;
}

void expect_same(const DetectResult& found, const DetectResult& expected, const std::string& where) {
  EXPECT_EQ(found.step, expected.step) << where;
  for_each_list([&]<class Row>(const ResultList<Row>& list, auto member) {
    expect_same<Row>(list.name, member(found), member(expected), where);
  });
  expect_same<ContactGroup>("groups", found.groups, expected.groups, where);
  expect_same<ContactGroup>("continuous_groups", found.continuous_groups, expected.continuous_groups, where);
  expect_same<ContactGroup>("proximity_groups", found.proximity_groups, expected.proximity_groups, where);
  expect_same<NonFiniteVertex>("non_finite", found.non_finite_vertices, expected.non_finite_vertices, where);
  expect_same<ObjectPair>("volume stay", found.volume_events.stay, expected.volume_events.stay, where);
  expect_same<ObjectPair>("contact stay", found.contact_events.stay, expected.contact_events.stay, where);
}

class Lives {
 public:
  Lives(std::uint64_t seed, const DistributedOptions& options)
      : random(seed), plain(options.scene), distributed(MPI_COMM_WORLD, options) {}

  void add_object(bool may_be_solid) {
    LivingObject object;
    switch (random.below(5)) {
      case 0:
        object.mesh = make_icosphere(2 + random.below(5));
        break;
      case 1:
        object.mesh = make_torus(8 + random.below(8), 6 + random.below(4));
        break;
      case 2:
        object.mesh = make_cloth(3 + random.below(12), 3 + random.below(12));
        break;
      case 3:
        object.mesh = make_box({0.6, 0.7, 0.8}, 1 + random.below(4));
        break;
      default:
        object.mesh = soup();
        break;
    }
    const bool is_closed = object.mesh.name != "cloth" && object.mesh.name != "soup";
    ObjectOptions& options = object.options;
    options.name = "object " + std::to_string(added_++);
    options.self_collision = random.below(3) == 0;
    if (random.below(4) == 0) options.neighbours = Neighbours::exact;
    options.margin = random.below(2) * random.uniform(0, 0.1);
    options.min_separation = random.below(4) == 0 ? random.uniform(0, 0.02) : 0;
    options.is_static = random.below(6) == 0;
    options.solid = may_be_solid && is_closed && random.below(2) == 0;
    if (random.below(5) == 0) options.group = 2 + random.below(2);
    if (random.below(5) == 0) options.mask = ~std::uint32_t{2};
    if (random.below(4) == 0 && object.mesh.positions.size() > 4) {
      options.edges = {{0, 2}, {1, 3}};
      options.points = {1, 4};
    }
    object.is_float = random.below(3) == 0;
    object.place = random.vector(1.5);
    object.now = moved(object);
    object.id = with_positions(object, object.now, nullptr, [&](const PositionsView& view) {
      return plain.add(view, object.mesh.triangles, options);
    });
    settle(object);
    objects.push_back(std::move(object));
  }

  void change_ranks() {
    if (objects.empty()) return;
    LivingObject& object = objects[random.below(static_cast<std::uint32_t>(objects.size()))];
    leave(object);
    settle(object);
    if (object.is_on_path) place(object);
  }

  void remove_object() {
    if (objects.empty()) return;
    const std::uint32_t which = random.below(static_cast<std::uint32_t>(objects.size()));
    plain.remove(objects[which].id);
    leave(objects[which]);
    objects.erase(objects.begin() + which);
  }

  void move_objects(bool crowd) {
    for (LivingObject& object : objects) {
      if (object.options.is_static || random.below(5) == 0) continue;
      object.place = crowd ? Vec3d{2, 2, 2} + random.vector(0.2) : object.place + random.vector(0.3);
      object.from = object.now;
      object.now = moved(object);
      object.is_on_path = random.below(2) == 0;
      if (random.below(8) == 0)
        object.now[random.below(static_cast<std::uint32_t>(object.now.size()))].y =
            random.below(2) == 0 ? std::numeric_limits<double>::quiet_NaN()
                                 : std::numeric_limits<double>::infinity();
      if (random.below(30) == 0) object.now[0].x = 1e30;
      place(object);
      with_views(
          object.is_float, nullptr,
          [&](const PositionsView& from, const PositionsView& now) {
            object.is_on_path ? plain.set_motion(object.id, from, now) : plain.set_positions(object.id, now);
          },
          object.from, object.now);
    }
  }

  RandomNumbers random;
  Scene plain;
  DistributedScene distributed;
  std::vector<LivingObject> objects;

 private:
  TriangleMesh soup() {
    TriangleMesh mesh{.name = "soup", .positions = {}, .triangles = {}};
    const std::uint32_t vertices = 4 + random.below(20);
    for (std::uint32_t v = 0; v < vertices; ++v) mesh.positions.push_back(random.vector(0.6));
    const std::uint32_t triangles = random.below(30);
    for (std::uint32_t t = 0; t < triangles; ++t)
      mesh.triangles.push_back({random.below(vertices), random.below(vertices), random.below(vertices)});
    return mesh;
  }

  std::vector<Vec3d> moved(const LivingObject& object) {
    std::vector<Vec3d> positions;
    const Vec3d stretch{random.uniform(0.7, 1.3), random.uniform(0.7, 1.3), random.uniform(0.7, 1.3)};
    const double noise = random.below(2) * 0.01;
    for (const Vec3d& p : object.mesh.positions)
      positions.push_back(object.place + Vec3d{p.x * stretch.x, p.y * stretch.y, p.z * stretch.z} +
                          random.vector(noise));
    if (object.is_float) {
      for (Vec3d& p : positions) p = {float(p.x), float(p.y), float(p.z)};
    }
    return positions;
  }

  template <class Use>
  static ObjectId with_positions(const LivingObject& object, const std::vector<Vec3d>& positions,
                                 const std::vector<std::uint32_t>* some, const Use& use) {
    ObjectId id;
    with_views(
        object.is_float, some, [&](const PositionsView& view) { id = use(view); }, positions);
    return id;
  }

  /// Gives the object, or parts of it, to ranks.
  void settle(LivingObject& object) {
    const auto ranks = static_cast<std::uint32_t>(size_of_world());
    object.home = static_cast<int>(random.below(ranks));
    object.rank_of_triangle.clear();
    const bool has_extra = !object.options.edges.empty() || !object.options.points.empty();
    if (random.below(2) == 0 && !has_extra && !object.mesh.triangles.empty()) {
      const std::uint32_t way = random.below(2);
      for (std::uint32_t t = 0; t < object.mesh.triangles.size(); ++t) {
        const auto count = static_cast<std::uint32_t>(object.mesh.triangles.size());
        object.rank_of_triangle.push_back(
            static_cast<int>(way == 0 ? t * ranks / count : random.below(ranks)));
      }
    }
    for_my_part(object, [&](const Part* part) {
      with_views(
          object.is_float, part != nullptr ? &part->vertices : nullptr,
          [&](const PositionsView& view) {
            if (part == nullptr) {
              distributed.add(object.id, view, object.mesh.triangles, object.options);
            } else {
              distributed.add_part(object.id, view, part->corners, {part->vertices, part->triangles},
                                   object.options);
            }
          },
          object.now);
    });
  }

  void leave(const LivingObject& object) {
    for_my_part(object, [&](const Part*) { distributed.remove(object.id); });
  }

  void place(const LivingObject& object) {
    for_my_part(object, [&](const Part* part) {
      with_views(
          object.is_float, part != nullptr ? &part->vertices : nullptr,
          [&](const PositionsView& from, const PositionsView& now) {
            object.is_on_path ? distributed.set_motion(object.id, from, now)
                              : distributed.set_positions(object.id, now);
          },
          object.from, object.now);
    });
  }

  template <class Use>
  static void for_my_part(const LivingObject& object, const Use& use) {
    if (object.rank_of_triangle.empty()) {
      if (object.home == rank_of_world()) use(nullptr);
      return;
    }
    const Part part = part_of(object, rank_of_world());
    if (!part.triangles.empty()) use(&part);
  }

  std::uint32_t added_ = 0;
};

/// How many lives each test has; the long test has more.
std::uint64_t life_count() {
  const char* const given = std::getenv("SUPPLE_LIVES");
  return given != nullptr ? static_cast<std::uint64_t>(std::atoi(given)) : 2;
}

DistributedOptions small_clusters() {
  DistributedOptions options;
  options.cluster_triangles = 16;
  options.scene.threads = 1;
  return options;
}

void live(std::uint64_t seed, ContactKinds contacts, const DistributedOptions& options, int steps) {
  Lives lives(seed, options);
  const bool is_deep = contains(contacts, ContactKinds::penetration);
  for (int i = 0; i < 6; ++i) lives.add_object(is_deep);
  for (int step = 0; step < steps; ++step) {
    const std::uint32_t what = lives.random.below(6);
    if (what == 0) lives.add_object(is_deep);
    if (what == 1) lives.remove_object();
    if (what == 2) lives.change_ranks();
    lives.move_objects(lives.random.below(6) == 0);
    const DetectResult& expected = lives.plain.detect({.contacts = contacts});
    const DetectResult& found = lives.distributed.detect({.contacts = contacts});
    for (const auto count : {&StepStats::object_pairs, &StepStats::contacts, &StepStats::proximity_pairs,
                             &StepStats::penetrations, &StepStats::curves})
      EXPECT_EQ(found.stats.*count, expected.stats.*count);
    if (lives.distributed.rank() == 0)
      expect_same(found, expected, "seed " + std::to_string(seed) + " step " + std::to_string(step));
    int failed = testing::Test::HasFailure() ? 1 : 0;
    MPI_Bcast(&failed, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (failed != 0) return;
  }
}

/// Each step of random lives equals that of one scene.
void live_all(ContactKinds contacts, const DistributedOptions& options) {
  for (std::uint64_t seed = 1; seed <= life_count(); ++seed)
    live(100 * static_cast<std::uint64_t>(contacts) + seed, contacts, options, 10);
}

TEST(DistributedScene, IntersectionsEqualOneScene) {
  live_all(ContactKinds::intersection, small_clusters());
}
TEST(DistributedScene, ContinuousContactsEqualOneScene) {
  live_all(ContactKinds::continuous, small_clusters());
}
TEST(DistributedScene, ProximityEqualsOneScene) {
  live_all(ContactKinds::proximity, small_clusters());
}
TEST(DistributedScene, ElementsOfProximityEqualOneScene) {
  DistributedOptions options = small_clusters();
  options.scene.proximity_listing = ProximityListing::elements;
  live_all(ContactKinds::proximity, options);
}
TEST(DistributedScene, PenetrationEqualsOneScene) {
  live_all(ContactKinds::penetration, small_clusters());
}
TEST(DistributedScene, AllKindsEqualOneScene) {
  const ContactKinds kinds = ContactKinds::intersection | ContactKinds::continuous | ContactKinds::proximity;
  live_all(kinds, small_clusters());
  live_all(kinds | ContactKinds::penetration, small_clusters());
}

/// Each contact is on exactly one rank, and each list is in canonical order.
void expect_spread(ResultPlacement placement) {
  DistributedOptions options = small_clusters();
  options.results = placement;
  std::uint64_t ranks_with_contacts = 0, contacts = 0;
  for (std::uint64_t seed = 61; seed < 61 + life_count(); ++seed) {
    Lives lives(seed, options);
    for (int i = 0; i < 8; ++i) lives.add_object(false);
    for (int step = 0; step < 6; ++step) {
      lives.move_objects(step == 3);
      const DetectResult& expected = lives.plain.detect();
      const DetectResult& found = lives.distributed.detect();
      const auto key = [](const Contact& c) {
        return std::tuple(c.object_a, c.object_b, c.triangle_a, c.triangle_b);
      };
      ASSERT_TRUE(std::is_sorted(found.contacts.begin(), found.contacts.end(),
                                 [&](const Contact& p, const Contact& q) { return key(p) < key(q); }));
      for (const Contact& contact : found.contacts) {
        const auto same =
            std::lower_bound(expected.contacts.begin(), expected.contacts.end(), contact,
                             [&](const Contact& p, const Contact& q) { return key(p) < key(q); });
        ASSERT_NE(same, expected.contacts.end());
        ASSERT_EQ(key(*same), key(contact));
        ASSERT_EQ(same->normal, contact.normal);
        const auto p = found.points_of(contact), q = expected.points_of(*same);
        ASSERT_TRUE(std::equal(p.begin(), p.end(), q.begin(), q.end()));
        if (placement != ResultPlacement::owner) continue;
        const auto owner = std::find_if(lives.objects.begin(), lives.objects.end(),
                                        [&](const LivingObject& o) { return o.id == contact.object_a; });
        const int home = owner->rank_of_triangle.empty() ? owner->home
                                                         : *std::min_element(owner->rank_of_triangle.begin(),
                                                                             owner->rank_of_triangle.end());
        ASSERT_EQ(home, lives.distributed.rank());
      }
      std::uint64_t totals[] = {found.contacts.size(), found.object_pairs.size(), !found.contacts.empty()};
      MPI_Allreduce(MPI_IN_PLACE, totals, 3, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
      ASSERT_EQ(totals[0], expected.contacts.size());
      ASSERT_EQ(totals[1], expected.object_pairs.size());
      contacts += totals[0];
      ranks_with_contacts = std::max(ranks_with_contacts, totals[2]);
    }
  }
  EXPECT_GT(contacts, 100u);
  EXPECT_EQ(ranks_with_contacts > 1, size_of_world() > 1);
}

TEST(DistributedScene, SpreadResultsAreOnOneRankEach) {
  expect_spread(ResultPlacement::spread);
}
TEST(DistributedScene, ResultsAreOnTheRankOfObjectA) {
  expect_spread(ResultPlacement::owner);
}

TEST(DistributedScene, EarliestImpactsEqualOneScene) {
  int impacts = 0;
  for (std::uint64_t seed = 71; seed < 72 + 2 * life_count(); ++seed) {
    Lives lives(seed, small_clusters());
    for (int i = 0; i < 6; ++i) lives.add_object(false);
    for (int step = 0; step < 4; ++step) {
      lives.move_objects(false);
      const auto expected = lives.plain.earliest_impact();
      EXPECT_EQ(lives.distributed.earliest_impact(), expected) << "seed " << seed << " step " << step;
      EXPECT_EQ(lives.distributed.max_step(), lives.plain.max_step());
      impacts += expected.has_value() ? 1 : 0;
    }
  }
  EXPECT_GT(impacts, 1);
}

TEST(DistributedScene, WorkIsSpreadOverTheRanks) {
  DistributedOptions options = small_clusters();
  options.cluster_triangles = 64;
  DistributedScene scene(MPI_COMM_WORLD, options);
  const TriangleMesh ball = make_icosphere(8);
  // All on rank 0; the computation spreads.
  std::vector<Vec3d> positions = ball.positions;
  for (std::uint32_t i = 0; i < 64 && scene.rank() == 0; ++i) {
    const Vec3d place{0.8 * (i % 4), 0.8 * (i / 4 % 4), 0.8 * (i / 16)};
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = ball.positions[v] + place;
    scene.add(ObjectId{i}, positions, ball.triangles);
  }
  scene.detect();
  EXPECT_TRUE(scene.stats().divided);
  EXPECT_GT(scene.stats().triangles, 0u);
  EXPECT_LT(scene.stats().imbalance, 1.8);
  scene.detect();
  const std::uint64_t sent = scene.stats().bytes_sent;
  scene.detect();
  EXPECT_FALSE(scene.stats().divided);
  EXPECT_EQ(scene.stats().bytes_sent, sent);  // boxes, requests and results, but no positions
  EXPECT_EQ(scene.stats().bytes_sent > 0, scene.rank_count() > 1);
}

}  // namespace
}  // namespace supple
