#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "geometry/vector.hpp"
#include "queries/check_queries.hpp"
#include "queries/pairs/nearest_pair.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/verify.hpp"
#include "verify/brute_force.hpp"

namespace supple {
namespace {

/// Queries do not read the groups of vertices.
PlainObject object_of_queries(const WorldObject& object) {
  PlainObject plain = plain_object(object);
  plain.groups = {};
  return plain;
}

/// Calls `check(i)` for all i below `count`, on all threads. It returns both answers when they differ.
template <class Check>
std::vector<WrongAnswer> wrong_answers(const Parallel& parallel, std::size_t count, const Check& check) {
  std::vector<std::optional<WrongAnswer>> wrong(count);
  parallel.for_ranges(count, 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) wrong[i] = check(i);
  });
  std::vector<WrongAnswer> all;
  for (std::size_t i = 0; i < count; ++i) {
    if (wrong[i]) all.push_back({i, wrong[i]->found, wrong[i]->expected});
  }
  return all;
}

/// The first place at which two lists differ. `describe_found` and `describe_truth` give the words of an
/// item.
template <class Found, class Truth, class Equal, class DescribeFound, class DescribeTruth>
std::optional<WrongAnswer> compare_lists(std::span<const Found> found, std::span<const Truth> truth,
                                         const Equal& equal, const DescribeFound& describe_found,
                                         const DescribeTruth& describe_truth) {
  if (std::ranges::equal(found, truth, equal)) return {};
  const auto differ = std::ranges::mismatch(found, truth, equal);
  const auto place = differ.in1 - found.begin();
  const auto item = [&](bool is_end, const auto& describe) {
    return std::to_string(place) + ": " + (is_end ? "nothing" : describe());
  };
  return WrongAnswer{0, item(differ.in1 == found.end(), [&] { return describe_found(*differ.in1); }),
                     item(differ.in2 == truth.end(), [&] { return describe_truth(*differ.in2); })};
}

/// Throws an error unless the items stand by ascending query, like those of the scene.
template <class Item>
void check_order(std::span<const Item> items, std::size_t count, const char* call) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].query >= count || (i > 0 && items[i].query < items[i - 1].query))
      fail(std::string(call) + ": item " + std::to_string(i) + " of the list is for query " +
           std::to_string(items[i].query) + "; give the list as the query returned it");
  }
}
template <class Item>
std::span<const Item> items_of(std::span<const Item> items, std::size_t query) {
  const auto found = std::ranges::equal_range(items, query, {}, &Item::query);
  return {found.begin(), found.end()};
}

/// Both answers, or that there is none.
template <class Answer, class Describe>
WrongAnswer wrong_answer(const std::optional<Answer>& found, const std::optional<Answer>& truth,
                         const Describe& describe) {
  return {0, found ? describe(*found) : "nothing", truth ? describe(*truth) : "nothing"};
}

/// Names objects in the words of answers, also those that are not in the scene.
class AnswerWords {
 public:
  explicit AnswerWords(const World& world) : world_(world) {}

  std::string triangle(ObjectId object, std::uint32_t triangle) const {
    return "triangle " + std::to_string(triangle) + " of " + name(object);
  }
  std::string hit(const RayHit& hit, bool counts) const {
    const std::string text = triangle(hit.object, hit.triangle) + ", t " + text_of(hit.t);
    return counts ? text + ", hits " + std::to_string(hit.hits) : text;
  }
  std::string name(ObjectId object) const {
    const std::string number = "object " + std::to_string(object.index);
    if (!world_.contains(object)) return number + " (not in the scene)";
    return number + " (" + world_[object.index].options.name + ")";
  }
  std::string element(FeatureKind kind, const std::array<std::uint32_t, 2>& ids) const {
    const std::string text = std::string(word_of(kind)) + " " + std::to_string(ids[0]);
    return kind == FeatureKind::edge ? text + " " + std::to_string(ids[1]) : text;
  }

 private:
  const World& world_;
};

/// The objects that the filter lets through.
PlainScene plain_scene(const World& world, const QueryFilter& seen, const char* call) {
  if (seen.object) world.object(*seen.object, call);
  PlainScene plain;
  for (const ObjectId id : world.objects()) {
    const WorldObject& found = world[id.index];
    if (!sees(seen, id, found.options)) continue;
    plain.ids.push_back(id);
    plain.surfaces.emplace_back(object_of_queries(found));
  }
  return plain;
}

RayHit rounded_hit(const PlainScene& scene, const ExactHit& exact, std::uint64_t count) {
  RayHit hit;
  hit.object = scene.ids[exact.surface];
  hit.triangle = exact.triangle;
  hit.t = exact.t.convert_to<double>();
  hit.hits = count;
  return hit;
}
bool is_same_hit(const RayHit& found, const RayHit& truth, const Rational& t) {
  return found.object == truth.object && found.triangle == truth.triangle && found.hits == truth.hits &&
         is_accurate(found.t, t * t);
}

template <class Region>
std::vector<WrongAnswer> wrong_overlaps(const World& world, std::span<const Region> regions,
                                        std::span<const Overlap> overlaps, const QueryFilter& seen) {
  check_order(overlaps, regions.size(), "verify_overlaps");
  const PlainScene plain = plain_scene(world, seen, "verify_overlaps");
  const AnswerWords words(world);
  return wrong_answers(world.parallel, regions.size(), [&](std::size_t i) {
    std::vector<Overlap> truth;
    for (std::size_t s = 0; s < plain.surfaces.size(); ++s) {
      for (const BoxedCorners& t : plain.surfaces[s].triangles) {
        if (overlaps_by_brute_force(regions[i], t))
          truth.push_back({static_cast<std::uint32_t>(i), plain.ids[s], t.triangle});
      }
    }
    const auto describe = [&](const Overlap& o) { return words.triangle(o.object, o.triangle); };
    return compare_lists(items_of(overlaps, i), std::span<const Overlap>(truth), std::equal_to<>(), describe,
                         describe);
  });
}
/// Both answers in words when they differ. `found` is null when nothing was found.
std::optional<WrongAnswer> wrong_distance(const World& world, const ObjectPair& pair, double max_distance,
                                          const ProximityPair* found) {
  const auto with_extra_elements = [&](ObjectId id) {
    PlainObject plain = object_of_queries(world[id.index]);
    plain.face_count = plain.triangles.size();
    return plain;
  };
  const PlainObject a = with_extra_elements(pair.a), b = with_extra_elements(pair.b);
  const std::optional<ExactPair> truth = nearest_pair_by_brute_force(a, b, max_distance, world.parallel);
  const AnswerWords words(world);
  const auto is_on_first_contact = [&] {
    const auto corners_of = [](FeatureKind kind, const std::array<std::uint32_t, 2>& ids,
                               const PlainObject& object,
                               std::uint32_t triangle) -> std::optional<TrianglePoints> {
      const Triangle& whole = object.triangles[triangle];
      const auto has = [&](std::uint32_t v) { return std::ranges::find(whole, v) != whole.end(); };
      const auto& at = object.end;
      if (kind == FeatureKind::face) {
        if (ids != std::array{triangle, triangle}) return {};
        return object.corners(triangle);
      }
      if (!has(ids[0]) || !has(ids[1]) || (kind == FeatureKind::vertex) != (ids[0] == ids[1])) return {};
      return TrianglePoints{at[ids[0]], at[ids[1]], at[ids[1]]};
    };
    const auto on_a = corners_of(found->kind_a, found->element_a, a, truth->contact->a),
               on_b = corners_of(found->kind_b, found->element_b, b, truth->contact->b);
    return found->distance == 0 && on_a && on_b && found->on_a == Feature{found->kind_a, 0} &&
           found->on_b == Feature{found->kind_b, 0} && triangles_intersect_by_axes(*on_a, *on_b);
  };
  const auto is_nearest = [&] {
    const NearElements& near = truth->nearest;
    return found->kind_a == near.kind_a && found->kind_b == near.kind_b &&
           found->element_a == near.element_a && found->element_b == near.element_b &&
           found->on_a == near.on_a && found->on_b == near.on_b && is_accurate(found->distance, near.squared);
  };
  const auto is_right = [&] {
    if (found == nullptr || !truth) return found == nullptr && !truth;
    if (found->object_a != pair.a || found->object_b != pair.b) return false;
    return truth->contact ? is_on_first_contact() : is_nearest();
  };
  if (is_right()) return {};
  const auto describe = [&](const auto& of, double distance) {
    return words.element(of.kind_a, of.element_a) + " and " + words.element(of.kind_b, of.element_b) +
           ", distance " + text_of(distance);
  };
  std::string of_found = words.name(pair.a) + " and " + words.name(pair.b) + ": ", of_truth = "nothing";
  of_found += found != nullptr ? describe(*found, found->distance) : "nothing";
  if (truth && truth->contact)
    of_truth = "distance 0, triangles " + std::to_string(truth->contact->a) + " and " +
               std::to_string(truth->contact->b) + " intersect";
  else if (truth)
    of_truth = describe(truth->nearest, rounded_root(truth->nearest.squared));
  return WrongAnswer{0, of_found, of_truth};
}

}  // namespace

std::vector<WrongAnswer> verify_closest(const Scene& scene, std::span<const Vec3d> points,
                                        std::span<const std::optional<ClosestPoint>> results,
                                        const ClosestOptions& query) {
  const World& world = SceneAccess::of(scene).world;
  check_counts(points.size(), results.size(), "verify_closest");
  check_distance(query.max_distance, "verify_closest");
  if (query.signed_distance) check_closed(world, query.filter, "verify_closest");
  const PlainScene plain = plain_scene(world, query.filter, "verify_closest");
  const AnswerWords words(world);
  const auto describe = [&](const ClosestPoint& p) {
    return words.triangle(p.object, p.triangle) + " at " + word_of(p.feature.kind) + " " +
           std::to_string(p.feature.index) + ", distance " + text_of(p.distance) + ", barycentric " +
           text_of(p.barycentric[0]) + " " + text_of(p.barycentric[1]) + " " + text_of(p.barycentric[2]);
  };
  return wrong_answers(world.parallel, points.size(), [&](std::size_t i) -> std::optional<WrongAnswer> {
    std::optional<ExactNearest> truth;
    if (is_finite(points[i])) truth = nearest_by_brute_force(points[i], plain.surfaces, query.max_distance);
    const bool is_inside = truth && query.signed_distance &&
                           plain.surfaces[truth->surface].containment(points[i]) == Containment::inside;
    std::optional<ClosestPoint> expected;
    if (truth) {
      const double distance = rounded_root(truth->distance.squared);
      expected.emplace();
      expected->object = plain.ids[truth->surface];
      expected->triangle = truth->triangle;
      expected->feature = truth->distance.on_b;
      expected->distance = is_inside ? -distance : distance;
      for (std::size_t k = 0; k < 3; ++k)
        expected->barycentric[k] = truth->distance.weights_b[k].convert_to<double>();
    }
    const std::optional<ClosestPoint>& found = results[i];
    const auto is_right = [&] {
      if (!found || !truth) return !found && !truth;
      for (std::size_t k = 0; k < 3; ++k) {
        if (!std::isfinite(found->barycentric[k])) return false;
        const Rational error = Rational(found->barycentric[k]) - truth->distance.weights_b[k];
        if (abs(error) > Rational(0x1p-50)) return false;
      }
      return found->object == expected->object && found->triangle == expected->triangle &&
             found->feature == expected->feature &&
             is_accurate(is_inside ? -found->distance : found->distance, truth->distance.squared);
    };
    if (is_right()) return {};
    return wrong_answer(found, expected, describe);
  });
}

std::vector<WrongAnswer> verify_cast(const Scene& scene, std::span<const Ray> rays,
                                     std::span<const std::optional<RayHit>> results,
                                     const CastOptions& query) {
  const World& world = SceneAccess::of(scene).world;
  check_counts(rays.size(), results.size(), "verify_cast");
  const PlainScene plain = plain_scene(world, query.filter, "verify_cast");
  const AnswerWords words(world);
  return wrong_answers(world.parallel, rays.size(), [&](std::size_t i) -> std::optional<WrongAnswer> {
    const std::vector<ExactHit> truth = hits_by_brute_force(rays[i], plain.surfaces);
    std::optional<RayHit> first;
    if (!truth.empty()) first = rounded_hit(plain, truth.front(), query.count_hits ? truth.size() : 1);
    const std::optional<RayHit>& found = results[i];
    if (found && first ? is_same_hit(*found, *first, truth.front().t) : !found && !first) return {};
    return wrong_answer(found, first, [&](const RayHit& hit) { return words.hit(hit, query.count_hits); });
  });
}

std::vector<WrongAnswer> verify_cast_all(const Scene& scene, std::span<const Ray> rays,
                                         std::span<const ListedRayHit> hits, const QueryFilter& seen) {
  const World& world = SceneAccess::of(scene).world;
  check_order(hits, rays.size(), "verify_cast_all");
  const PlainScene plain = plain_scene(world, seen, "verify_cast_all");
  const AnswerWords words(world);
  return wrong_answers(world.parallel, rays.size(), [&](std::size_t i) {
    const std::vector<ExactHit> truth = hits_by_brute_force(rays[i], plain.surfaces);
    const auto rounded = [&](const ExactHit& t) { return rounded_hit(plain, t, truth.size()); };
    return compare_lists(
        items_of(hits, i), std::span(truth),
        [&](const ListedRayHit& f, const ExactHit& t) { return is_same_hit(f.hit, rounded(t), t.t); },
        [&](const ListedRayHit& f) { return words.hit(f.hit, true); },
        [&](const ExactHit& t) { return words.hit(rounded(t), true); });
  });
}

std::vector<WrongAnswer> verify_overlaps(const Scene& scene, std::span<const QueryBox> boxes,
                                         std::span<const Overlap> found, const QueryFilter& filter) {
  return wrong_overlaps(SceneAccess::of(scene).world, boxes, found, filter);
}
std::vector<WrongAnswer> verify_overlaps(const Scene& scene, std::span<const QuerySphere> spheres,
                                         std::span<const Overlap> found, const QueryFilter& filter) {
  return wrong_overlaps(SceneAccess::of(scene).world, spheres, found, filter);
}

std::vector<WrongAnswer> verify_inside(const Scene& scene, std::span<const Vec3d> points,
                                       std::span<const Containment> results, const QueryFilter& seen) {
  const World& world = SceneAccess::of(scene).world;
  check_counts(points.size(), results.size(), "verify_inside");
  check_closed(world, seen, "verify_inside");
  const PlainScene plain = plain_scene(world, seen, "verify_inside");
  return wrong_answers(world.parallel, points.size(), [&](std::size_t i) -> std::optional<WrongAnswer> {
    Containment truth = Containment::outside;
    for (const PlainSurface& surface : plain.surfaces) {
      if (is_finite(points[i])) truth = std::max(truth, surface.containment(points[i]));
    }
    if (results[i] == truth) return {};
    return WrongAnswer{0, word_of(results[i]), word_of(truth)};
  });
}

std::vector<WrongAnswer> verify_distance(const Scene& scene, ObjectId a, ObjectId b,
                                         const std::optional<ProximityPair>& found) {
  const World& world = SceneAccess::of(scene).world;
  const ObjectPair pair = world.two_objects(a, b, "verify_distance");
  const auto wrong = wrong_distance(world, pair, any_distance, found ? &*found : nullptr);
  return wrong ? std::vector{*wrong} : std::vector<WrongAnswer>{};
}

std::vector<WrongAnswer> verify_distances(const Scene& scene, double max_distance,
                                          std::span<const ProximityPair> found) {
  const World& world = SceneAccess::of(scene).world;
  check_distance(max_distance, "verify_distances");
  const AnswerWords words(world);
  std::vector<WrongAnswer> wrong;
  std::uint64_t place = 0;
  const auto note_added = [&](const ProximityPair& added) {
    wrong.push_back({place,
                     words.name(added.object_a) + " and " + words.name(added.object_b) + ": distance " +
                         text_of(added.distance),
                     "no such pair at this place of the list"});
  };
  const auto compare = [&](const ObjectPair& pair, const ProximityPair* listed) {
    if (const auto differs = wrong_distance(world, pair, max_distance, listed))
      wrong.push_back({place, differs->found, differs->expected});
    ++place;
  };
  std::vector<ObjectPair> pairs = world.all_pairs();
  std::erase_if(pairs, [](const ObjectPair& pair) { return pair.a == pair.b; });
  const auto objects_of = [](const auto& of) {
    if constexpr (requires { of.object_a; })
      return ObjectPair{of.object_a, of.object_b};
    else
      return of;
  };
  match(
      found, std::span<const ObjectPair>(pairs), objects_of, note_added,
      [&](const ObjectPair& pair) { compare(pair, nullptr); },
      [&](const ProximityPair& listed, const ObjectPair& pair) { compare(pair, &listed); });
  return wrong;
}

std::vector<WrongAnswer> verify_any_contact(const Scene& scene, ObjectId a, ObjectId b, bool found) {
  const World& world = SceneAccess::of(scene).world;
  const ObjectPair pair = world.two_objects(a, b, "verify_any_contact");
  const auto contacts = intersecting_pairs_by_brute_force(
      object_of_queries(world[pair.a.index]), object_of_queries(world[pair.b.index]), false, world.parallel);
  if (contacts.empty() != found) return {};
  return {{0, found ? "a contact" : "no contact",
           contacts.empty() ? "no contact"
                            : "triangles " + std::to_string(contacts.front().a) + " and " +
                                  std::to_string(contacts.front().b) + " intersect"}};
}

}  // namespace supple
