// Lives of scenes: objects come, move in every way, change their options and go. Two scenes with different
// options that must not change results live the same life and must agree. One of them is compared with brute
// force. Events, explanations, queries and all invariants are checked.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/event_ledger.hpp"

namespace {

using namespace supple;
using fuzz::check;

constexpr int most_operations = 60;
constexpr std::size_t most_objects = 6;

void check_answers(const std::vector<WrongAnswer>& wrong, const std::string& what) {
  if (!wrong.empty()) check(false, what + " is " + wrong[0].found + " instead of " + wrong[0].expected);
}

template <class Value>
void check_same(std::span<const Value> a, std::span<const Value> b, const char* what) {
  check(std::equal(a.begin(), a.end(), b.begin(), b.end()), what);
}

/// The kinds that a scene with boxes and one with other volumes, another broad phase or another octree share.
void check_agreement(const DetectResult& a, const DetectResult& b) {
  check_same(a.contacts, b.contacts, "contacts depend on options");
  check_same(a.contact_points, b.contact_points, "contact points depend on options");
  check_same(a.continuous_contacts, b.continuous_contacts, "continuous contacts depend on options");
  check_same(a.proximity_pairs, b.proximity_pairs, "proximity pairs depend on options");
  check_same(a.penetrations, b.penetrations, "penetrations depend on options");
  check_same(a.vertices_on_surface, b.vertices_on_surface, "vertices on surfaces depend on options");
  check_same(a.contained_parts, b.contained_parts, "contained parts depend on options");
  check_same(a.curves, b.curves, "curves depend on options");
  check_same(a.curve_contacts, b.curve_contacts, "contacts of curves depend on options");
  check_same(a.enclosed_vertices, b.enclosed_vertices, "enclosed vertices depend on options");
  check(a.non_finite_vertices.size() == b.non_finite_vertices.size(),
        "non-finite vertices depend on options");
}

class Life {
 public:
  explicit Life(fuzz::ByteReader& bytes)
      : bytes_(bytes), coordinate_(bytes), scenes_{Scene(draw_options()), Scene(draw_options())} {}

  void live() {
    for (int i = 0; i < most_operations && !bytes_.at_end(); ++i) {
      if (objects_.size() < 2 || (objects_.size() < most_objects && bytes_.below(6) == 0)) {
        add();
      } else if (bytes_.below(4) == 0) {
        detect();
      } else {
        change();
      }
    }
    detect();
  }

 private:
  struct Object {
    ObjectId id;
    std::vector<Vec3d> positions;
    std::set<std::uint32_t> removed{};
  };

  SceneOptions draw_options() {
    SceneOptions options;
    options.bounding_volume = static_cast<BoundingVolume>(bytes_.below(6));
    options.broad_phase = static_cast<BroadPhaseMethod>(bytes_.below(5));
    options.threads = 1;
    options.comparison.colliding_vertices = bytes_.below(8) == 0;
    return options;
  }

  ObjectOctreeOptions draw_octree() {
    ObjectOctreeOptions octree;
    octree.build = static_cast<ObjectOctreeBuild>(bytes_.below(3));
    octree.max_level = bytes_.below(6);
    octree.leaf_size = 1 + bytes_.below(6);
    if (octree.build != ObjectOctreeBuild::balanced) octree.arity = 2u << bytes_.below(3);
    return octree;
  }

  TriangleMesh draw_mesh() {
    TriangleMesh mesh;
    const std::uint32_t shape = bytes_.below(4);
    if (shape == 0) {  // a solid
      for (int i = 0; i < 4; ++i) mesh.positions.push_back(coordinate_.point());
      mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
      return mesh;
    }
    for (std::uint32_t i = 1 + bytes_.below(9); i > 0; --i) mesh.positions.push_back(coordinate_.point());
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const auto vertex = [&] { return bytes_.byte() % count; };
    for (std::uint32_t i = bytes_.below(9); i > 0; --i)
      mesh.triangles.push_back({vertex(), vertex(), vertex()});
    if (shape == 1) {
      mesh.points.push_back(vertex());
      if (const std::uint32_t a = vertex(), b = vertex(); a != b) mesh.edges.push_back({a, b});
    }
    return mesh;
  }

  /// Calls the function for both scenes; both must accept or refuse it with the same words.
  template <class Function>
  bool both(Function function) {
    std::array<std::string, 2> errors;
    for (std::size_t i = 0; i < 2; ++i) {
      try {
        function(scenes_[i], i);
      } catch (const Error& error) {
        errors[i] = error.what();
        fuzz::check_message(errors[i], "");
      }
    }
    check(errors[0] == errors[1], "one scene refuses what the other accepts: " + errors[0] + errors[1]);
    return errors[0].empty();
  }

  void add() {
    const TriangleMesh mesh = draw_mesh();
    ObjectOptions options;
    const std::uint8_t flags = bytes_.byte();
    options.self_collision = (flags & 1) != 0;
    options.neighbours = (flags & 2) != 0 ? Neighbours::exact : Neighbours::skip;
    options.weld = (flags & 0x30) == 0x30;
    options.is_static = (flags & 12) == 12;
    options.solid = (flags & 64) != 0;
    options.margin = (flags & 128) != 0 ? draw_length() : 0;
    options.name = "object";
    std::array<ObjectId, 2> ids;
    const bool added = both([&](Scene& scene, std::size_t i) {
      ObjectOptions own = options;
      own.octree = draw_octree();
      ids[i] = scene.add(mesh, own);
    });
    if (!added) return;
    check(ids[0] == ids[1], "ids depend on options");
    objects_.push_back({ids[0], mesh.positions});
  }

  double draw_length() {
    const double length = std::abs(coordinate_()) / 4;
    return std::isfinite(length) ? length : 0;
  }

  std::vector<Vec3d> moved(const std::vector<Vec3d>& from) {
    std::vector<Vec3d> positions = from;
    const bool all = bytes_.flag();
    for (Vec3d& p : positions) {
      if (all || bytes_.below(3) == 0) p = coordinate_.point();
    }
    if (!positions.empty() && bytes_.below(16) == 0) positions.front().y = std::nan("");
    return positions;
  }

  /// The positions in memory with a stride that leaves them unaligned, as bytes.
  static std::vector<std::byte> unaligned(const std::vector<Vec3d>& positions) {
    std::vector<std::byte> memory(25 * positions.size() + 1);
    for (std::size_t i = 0; i < positions.size(); ++i)
      std::memcpy(memory.data() + 1 + 25 * i, &positions[i], sizeof(Vec3d));
    return memory;
  }

  void change() {
    Object& object = objects_[bytes_.byte() % objects_.size()];
    const ObjectId id = object.id;
    switch (bytes_.below(16)) {
      case 0:
      case 1: {
        object.positions = moved(object.positions);
        const auto memory = unaligned(object.positions);
        const auto* const first = reinterpret_cast<const double*>(memory.data() + 1);
        both([&](Scene& scene, std::size_t i) {
          if (i == 0) {
            scene.set_positions(id, object.positions);
          } else {
            scene.set_positions(id, PositionsView(first, object.positions.size(), 25));
          }
        });
        return;
      }
      case 2: {
        const std::vector<Vec3d> to = moved(object.positions);
        both([&](Scene& scene, std::size_t) { scene.set_motion(id, object.positions, to); });
        object.positions = to;
        return;
      }
      case 3: {
        const Vec3d offset = coordinate_.point();
        both([&](Scene& scene, std::size_t) { scene.translate(id, offset); });
        return;
      }
      case 4: {
        RigidTransform transform;
        for (double& entry : transform.rotation) entry = bytes_.flag() ? coordinate_() : 0;
        transform.translation = coordinate_.point();
        both([&](Scene& scene, std::size_t) { scene.set_transform(id, transform); });
        return;
      }
      case 5: {
        std::vector<std::uint32_t> vertices;
        std::vector<Vec3d> positions;
        for (std::uint32_t v = 0; v < object.positions.size(); ++v) {
          if (bytes_.below(3) > 0) continue;
          vertices.push_back(v);
          positions.push_back(coordinate_.point());
        }
        both([&](Scene& scene, std::size_t) { scene.set_vertices(id, vertices, positions); });
        return;
      }
      case 6: {
        std::vector<Vec3f> floats;
        for (const Vec3d& p : moved(object.positions))
          floats.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        both([&](Scene& scene, std::size_t) { scene.set_positions(id, floats); });
        return;
      }
      case 7: {
        const bool is_static = bytes_.flag();
        both([&](Scene& scene, std::size_t) { scene.set_options(id, {.is_static = is_static}); });
        return;
      }
      case 8: {
        const std::uint32_t group = bytes_.below(4), mask = bytes_.below(4);
        both([&](Scene& scene, std::size_t) { scene.set_options(id, {.group = group, .mask = mask}); });
        return;
      }
      case 9: {
        const double length = draw_length();
        const bool margin = bytes_.flag();
        both([&](Scene& scene, std::size_t) {
          margin ? scene.set_options(id, {.margin = length})
                 : scene.set_options(id, {.min_separation = length});
        });
        return;
      }
      case 10: {
        const bool self = bytes_.flag();
        both([&](Scene& scene, std::size_t) { scene.set_options(id, {.self_collision = self}); });
        return;
      }
      case 11: {
        std::vector<std::uint32_t> groups, masks;
        for (std::size_t v = bytes_.flag() ? object.positions.size() : 0; v > 0; --v) {
          groups.push_back(bytes_.below(4));
          masks.push_back(1 + bytes_.below(3));
        }
        both([&](Scene& scene, std::size_t) { scene.set_vertex_groups(id, groups, masks); });
        return;
      }
      case 12:
        query();
        return;
      case 13:
      case 14:
        edit(object);
        return;
      default:
        both([&](Scene& scene, std::size_t) { scene.remove(id); });
        std::erase_if(objects_, [&](const Object& o) { return o.id == id; });
    }
  }

  /// The triangles and vertices of an edit can be wrong; then nothing changes.
  void edit(Object& object) {
    std::vector<std::uint32_t> removed, points;
    std::vector<Triangle> added;
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<Vec3d> vertices, starts;
    const auto triangles = static_cast<std::uint32_t>(scenes_[0].triangle_count(object.id));
    for (std::uint32_t t = 0; t < triangles + (bytes_.below(16) == 0 ? 1 : 0); ++t) {
      if (bytes_.below(3) == 0) removed.push_back(t);
    }
    for (std::uint32_t i = bytes_.below(3); i > 0; --i) vertices.push_back(coordinate_.point());
    if (bytes_.below(2) == 0) starts = vertices;
    const auto count = static_cast<std::uint32_t>(object.positions.size() + vertices.size());
    const auto vertex = [&] { return bytes_.byte() % std::max(count, 1u); };
    for (std::uint32_t i = bytes_.below(5); i > 0; --i) added.push_back({vertex(), vertex(), vertex()});
    if (bytes_.below(8) == 0) points.push_back(vertex());
    if (bytes_.below(8) == 0) edges.push_back({vertex(), vertex()});
    const MeshEdit change{.removed = removed,
                          .added = added,
                          .new_vertices = vertices,
                          .new_starts = starts,
                          .added_edges = edges,
                          .added_points = points};
    if (both([&](Scene& scene, std::size_t) { scene.edit(object.id, change); })) {
      object.positions.insert(object.positions.end(), vertices.begin(), vertices.end());
      object.removed.insert(removed.begin(), removed.end());
    } else {
      check(scenes_[0].triangle_count(object.id) == triangles, "a refused edit adds triangles");
      check(scenes_[0].vertex_count(object.id) == object.positions.size(), "a refused edit adds vertices");
    }
    if (bytes_.below(8) > 0) return;
    both([&](Scene& scene, std::size_t) { scene.compact(object.id); });
    object.removed.clear();
  }

  void detect() {
    DetectRequest request;
    std::uint32_t kinds = bytes_.below(16);
    if (!coordinate_.is_quick()) kinds &= ~2u;  // any bits can make exact impacts slow
    request.contacts = static_cast<ContactKinds>(kinds);
    request.curves = contains(*request.contacts, ContactKinds::penetration);
    request.proximity_listing = static_cast<ProximityListing>(bytes_.below(2));
    request.element_kinds = static_cast<ElementKinds>(bytes_.below(3));
    request.continuous_listing = static_cast<ContinuousListing>(bytes_.below(2));
    ImpactOptions impact;
    if ((kinds & 2) != 0 && bytes_.below(4) == 0) impact.min_separation = draw_length();
    request.impact = impact;
    std::array<const DetectResult*, 2> results{};
    if (!both([&](Scene& scene, std::size_t i) { results[i] = &scene.detect(request); })) return;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string error = SceneInspector(scenes_[i]).validate();
      check(error.empty(), error);
      ledgers_[i].apply(*results[i]);
    }
    check_agreement(*results[0], *results[1]);
    if (kinds == 0 || !is_verified()) return;
    check(verify(scenes_[0]).agrees(), "the result differs from that of brute force");
    if (kinds == 1) explain(*results[0]);
  }

  /// Brute force takes most of the time, so only some of the results are compared with it.
  bool is_verified() { return coordinate_.is_quick() && bytes_.below(coordinate_.is_small() ? 3 : 12) == 0; }

  /// A pair is explained as a contact exactly when it is listed.
  void explain(const DetectResult& result) {
    if (objects_.empty()) return;
    const Scene& scene = scenes_[0];
    const Object &object_a = objects_[bytes_.byte() % objects_.size()],
                 &object_b = objects_[bytes_.byte() % objects_.size()];
    const ObjectId a = object_a.id, b = object_b.id;
    if (scene.triangle_count(a) == 0 || scene.triangle_count(b) == 0) return;
    const auto of_a = static_cast<std::uint32_t>(bytes_.byte() % scene.triangle_count(a));
    const auto of_b = static_cast<std::uint32_t>(bytes_.byte() % scene.triangle_count(b));
    if (object_a.removed.contains(of_a) || object_b.removed.contains(of_b)) return;
    const bool listed = std::any_of(result.contacts.begin(), result.contacts.end(), [&](const Contact& c) {
      const bool same_order =
          c.object_a == a && c.triangle_a == of_a && c.object_b == b && c.triangle_b == of_b;
      return same_order ||
             (c.object_a == b && c.triangle_a == of_b && c.object_b == a && c.triangle_b == of_a);
    });
    const PairExplanation explanation = SceneInspector(scene).explain(a, of_a, b, of_b);
    check((explanation.stage == PairStage::contact) == listed, "a pair is explained otherwise than listed");
  }

  void query() {
    if (!is_verified()) return;
    const std::array points{coordinate_.point(), coordinate_.point()};
    std::array<std::optional<ClosestPoint>, 2> nearest;
    const std::array rays{Ray{points[0], coordinate_.point()}};
    std::array<std::optional<RayHit>, 1> hits;
    std::array<Containment, 2> inside{};
    both([&](Scene& scene, std::size_t) {
      scene.closest(points, nearest);
      check_answers(verify_closest(scene, points, nearest), "a closest point");
      scene.cast(rays, hits);
      check_answers(verify_cast(scene, rays, hits), "a hit");
      const std::array spheres{QuerySphere{points[0], draw_length()}};
      const auto overlaps = scene.overlaps(spheres);
      check_answers(verify_overlaps(scene, spheres, overlaps), "an overlap");
    });
    both([&](Scene& scene, std::size_t) {
      scene.inside(points, inside);
      check_answers(verify_inside(scene, points, inside), "a containment");
    });
    const ObjectId a = objects_.front().id, b = objects_.back().id;
    both([&](Scene& scene, std::size_t) {
      const auto pair = scene.distance(a, b);
      check_answers(verify_distance(scene, a, b, pair), "a distance");
      check_answers(verify_any_contact(scene, a, b, scene.any_contact(a, b)), "whether two objects touch");
    });
  }

  fuzz::ByteReader& bytes_;
  fuzz::CoordinateReader coordinate_;
  std::array<Scene, 2> scenes_;
  std::vector<Object> objects_;
  std::array<fuzz::EventLedgers, 2> ledgers_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteReader bytes(data, size);
  Life(bytes).live();
  return 0;
}
