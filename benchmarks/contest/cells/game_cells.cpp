#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contest/cells/cells.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "workloads/random_numbers.hpp"

namespace supple::benchmarks {
namespace {

/// A pile of 400 solid crates and balls on a floor that shake: each touches its neighbours, and is a little
/// inside them or a little apart.
class Pile {
 public:
  Pile(const SceneOptions& options, double spacing) : scene(options), spacing_(spacing) {
    constexpr double margin = 0.02;
    const TriangleMesh crate = make_box({1, 1, 1}), ball = make_icosphere(3);
    for (int i = 0; i < side * side * layers; ++i) {
      const bool is_crate = i % 3 != 0;
      TriangleMesh mesh = is_crate ? crate : ball;
      if (!is_crate) {
        for (Vec3d& p : mesh.positions) p = 0.5 * p;
      }
      bodies_.push_back(scene.add(mesh, {.margin = margin, .solid = true}));
    }
    TriangleMesh floor = make_box({30, 1, 30}, 10);
    for (Vec3d& p : floor.positions) p.y -= 0.5;
    scene.add(floor, {.is_static = true, .margin = margin, .solid = true});
  }

  void advance() {
    for (int i = 0; i < static_cast<int>(bodies_.size()); ++i) {
      const auto around = [&](double size) { return random_.uniform(-size, size); };
      const Vec3d place{static_cast<double>(i % side), static_cast<double>(i / (side * side)),
                        static_cast<double>(i / side % side)};
      const Vec3d shift{around(0.01), around(0.01), around(0.01)};
      scene.set_transform(bodies_[static_cast<std::size_t>(i)],
                          RigidTransform::from_quaternion(around(0.01), around(0.01), around(0.01), 1,
                                                          spacing_ * (place + Vec3d{0, 0.5, 0}) + shift));
    }
  }

  Scene scene;

 private:
  static constexpr int side = 10, layers = 4;
  std::vector<ObjectId> bodies_;
  double spacing_;
  RandomNumbers random_{7};
};

/// What a plain loop finds: a normal and at most four points for each pair of objects.
struct OwnPoint {
  Vec3d position;
  double depth = 0;
  std::array<std::uint64_t, 2> features{};  // of a and of b
  std::uint64_t id = 0;
};
struct OwnManifold {
  ObjectId a, b;
  Vec3d normal{};
  std::array<OwnPoint, 4> points{};
  std::size_t count = 0;
};

/// The deepest point, the farthest from it, the farthest from their line, and that on the other side.
void reduce(std::span<const OwnPoint> found, OwnManifold& manifold) {
  const auto add_largest = [&](const auto& value) {
    double most = 0;
    const OwnPoint* best = nullptr;
    for (const OwnPoint& point : found) {
      if (const double v = value(point); best == nullptr || v > most) {
        most = v;
        best = &point;
      }
    }
    if (manifold.count == 0 || most > 1e-6) manifold.points[manifold.count++] = *best;
  };
  add_largest([](const OwnPoint& p) { return p.depth; });
  const Vec3d first = manifold.points[0].position;
  add_largest([&](const OwnPoint& p) { return squared_norm(p.position - first); });
  if (manifold.count < 2) return;
  const Vec3d across = cross(manifold.normal, manifold.points[1].position - first);
  add_largest([&](const OwnPoint& p) { return dot(p.position - first, across); });
  add_largest([&](const OwnPoint& p) { return -dot(p.position - first, across); });
}

/// A manifold for each curve, of its points and of the vertices that it encloses beyond its plane; and for
/// each pair of objects within the margins, of the pairs with normals within 45 degrees of that of the
/// nearest.
void find_own_manifolds(const Scene& scene, std::vector<OwnPoint>& points,
                        std::vector<OwnManifold>& manifolds) {
  const DetectResult& result = scene.result();
  manifolds.clear();
  for (const IntersectionCurve& curve : result.curves) {
    points.clear();
    for (const ContactSide side : {ContactSide::a, ContactSide::b}) {
      const bool is_a = side == ContactSide::a;
      for (const std::uint32_t v : result.enclosed_vertices_of(curve, side)) {
        const Vec3d position = scene.position(is_a ? curve.a : curve.b, v);
        const double height = (is_a ? -1 : 1) * dot(position - curve.centroid, curve.normal);
        if (height > 0)
          points.push_back({position, std::min(height, curve.depth), {is_a ? v : 0, is_a ? 0 : v}});
      }
    }
    const double depth = points.empty() ? curve.depth : 0;
    for (const std::uint32_t i : result.contacts_of(curve)) {
      const Contact& contact = result.contacts[i];
      std::uint64_t k = 0;
      for (const ContactPoint& p : result.points_of(contact)) {
        points.push_back({p.position, depth, {++k << 32 | contact.triangle_a, k << 32 | contact.triangle_b}});
      }
    }
    reduce(points, manifolds.emplace_back(OwnManifold{curve.a, curve.b, curve.normal}));
  }
  for (const ContactGroup& group : result.proximity_groups) {
    points.clear();
    const std::span<const ProximityPair> pairs = result.proximity_pairs_of(group);
    const ProximityPair& nearest = *std::ranges::min_element(pairs, {}, &ProximityPair::distance);
    for (const ProximityPair& p : pairs) {
      if (dot(p.normal, nearest.normal) < 0.7) continue;
      const auto feature = [](const std::array<std::uint32_t, 2>& e) {
        return std::uint64_t{e[0]} << 32 | e[1];
      };
      points.push_back(
          {0.5 * (p.point_a + p.point_b), -p.distance, {feature(p.element_a), feature(p.element_b)}});
    }
    reduce(points, manifolds.emplace_back(OwnManifold{group.a, group.b, nearest.normal}));
  }
}

/// Gives each point the id of the point of the last frame with the same features, else that of the nearest
/// one that is within 0.1 and has no successor yet. Both lists are in the order of objects.
void match(std::vector<OwnManifold>& last, std::vector<OwnManifold>& manifolds, std::uint64_t& last_id) {
  const auto objects = [](const OwnManifold& m) { return std::pair(m.a, m.b); };
  auto old = last.begin();
  for (OwnManifold& manifold : manifolds) {
    while (old != last.end() && objects(*old) < objects(manifold)) ++old;
    const bool is_old = old != last.end() && objects(*old) == objects(manifold);
    const std::span old_points = std::span(is_old ? old->points.data() : nullptr, is_old ? old->count : 0);
    const std::span new_points = std::span(manifold.points).first(manifold.count);
    for (OwnPoint& point : new_points) {
      for (OwnPoint& other : old_points) {
        if (other.id != 0 && other.features == point.features) {
          point.id = std::exchange(other.id, 0);
          break;
        }
      }
    }
    for (OwnPoint& point : new_points) {
      if (point.id != 0) continue;
      OwnPoint* nearest = nullptr;
      double least = 0.01;
      for (OwnPoint& other : old_points) {
        const double distance = squared_norm(other.position - point.position);
        if (distance >= least || other.id == 0) continue;
        least = distance;
        nearest = &other;
      }
      point.id = nearest != nullptr ? std::exchange(nearest->id, 0) : ++last_id;
    }
    if (is_old) ++old;
  }
}

}  // namespace

void run_game(const Choice& choice, const std::string& kinds, Output& output) {
  const auto contacts = kinds == "penetration" ? std::optional(ContactKinds::penetration)
                        : kinds == "proximity" ? std::optional(ContactKinds::proximity)
                                               : std::nullopt;
  if (!contacts) throw Error("a game has penetration or proximity, not '" + kinds + "'");
  SceneOptions options;
  options.threads = 1;
  options.contacts = *contacts;
  Pile pile(options, *contacts == ContactKinds::penetration ? 0.99 : 1.03);
  DetectRequest plain, with_manifolds;
  plain.curves = *contacts == ContactKinds::penetration;  // the loop reads them
  with_manifolds.manifolds = true;
  std::vector<double> plain_times, with_times, manifold_times, own_times;
  std::vector<OwnPoint> points;
  std::vector<OwnManifold> own, last_own;
  std::uint64_t last_id = 0;
  double manifolds = 0;
  for (std::size_t round = 0; round < choice.rounds; ++round) {
    pile.advance();
    double start = wall_milliseconds();
    pile.scene.detect(plain);
    plain_times.push_back(wall_milliseconds() - start);
    start = wall_milliseconds();
    std::swap(own, last_own);
    find_own_manifolds(pile.scene, points, own);
    match(last_own, own, last_id);
    own_times.push_back(wall_milliseconds() - start);
    // Two steps in a row, so that the manifolds of the second one stay.
    pile.scene.detect(with_manifolds);
    pile.advance();
    start = wall_milliseconds();
    const DetectResult& result = pile.scene.detect(with_manifolds);
    with_times.push_back(wall_milliseconds() - start);
    manifold_times.push_back(1e3 * result.stats.manifold_seconds);
    manifolds += static_cast<double>(result.manifolds.size()) / static_cast<double>(choice.rounds);
  }
  output.value("manifolds", manifolds);
  output.value("milliseconds", quantile(plain_times, 0.5));
  output.value("milliseconds with manifolds", quantile(with_times, 0.5));
  output.value("milliseconds of manifolds", quantile(manifold_times, 0.5));
  output.value("milliseconds of a plain loop", quantile(own_times, 0.5));
}

}  // namespace supple::benchmarks
