#include "verify/verify.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "answers/search_options.hpp"
#include "core/error.hpp"
#include "core/stop_signal.hpp"
#include "scene/scene_implementation.hpp"
#include "verify/brute_force.hpp"

namespace supple {
namespace {

/// Compares what was found for two objects, or for one object with itself. `group` has the contacts that were
/// reported; it is empty when there are none.
struct PairVerification {
  const World& world;
  const Question& question;
  const DetectResult& result;
  const ObjectPair& pair;
  VerifyReport& report;
  const WorldObject &object_a = world[pair.a.index], &object_b = world[pair.b.index];
  bool same_object = pair.a == pair.b;
  PlainObject a = plain_object(object_a), b = plain_object(object_b);
  std::vector<TrianglePair> touching{};

  void verify_contacts(const ContactGroup& group) {
    touching = intersecting_pairs_by_brute_force(a, b, same_object, world.parallel);
    std::vector<TrianglePair> reported;
    for (const Contact& contact : result.contacts_of(group))
      reported.push_back({contact.triangle_a, contact.triangle_b});
    const std::uint64_t count = a.face_count;
    report.triangle_pairs_checked += same_object ? count * (count - 1) / 2 : count * b.face_count;
    report.intersecting_pairs += touching.size();
    const auto note = [&](const std::vector<TrianglePair>& from, const std::vector<TrianglePair>& without,
                          bool missed) {
      std::vector<TrianglePair> difference;
      std::ranges::set_difference(from, without, std::back_inserter(difference));
      for (const TrianglePair& p : difference)
        report.differences.push_back({pair.a, pair.b, p.a, p.b, missed});
    };
    note(touching, reported, true);
    note(reported, touching, false);
  }

  void verify_impacts(const ContactGroup& group) const {
    ImpactOptions options = question.impact.impact;
    options.min_separation = question.separation_of(object_a, object_b);
    const BruteForceImpacts truth =
        find_impacts_by_brute_force(plain_object(object_a, false), plain_object(object_b, false), same_object,
                                    options, question.impact.kinds, world.parallel);
    report.element_pairs_checked += truth.pairs_checked;
    report.touching_element_pairs += truth.touching.size();
    compare_impacts(pair, result.continuous_contacts_of(group), truth.touching, question.impact.listing,
                    result.continuous_contacts, report.continuous_differences);
  }

  void verify_proximity(const ContactGroup& group) const {
    const BruteForceProximity truth = find_proximity_by_brute_force(
        a, b, same_object, reach_of_margins(object_a.options.margin, object_b.options.margin),
        question.proximity_listing, question.impact.kinds, world.parallel);
    report.proximity_pairs_checked += truth.pairs_checked;
    report.near_pairs += truth.near.size();
    compare_proximity(pair, result.proximity_pairs_of(group), truth.near, report.proximity_differences);
  }

  /// Both objects in each other, where the other one is solid.
  void verify_penetrations() const {
    if (same_object) return;
    const auto inside = [&](const ObjectPair& in_order, const PlainObject& inner, const PlainObject& outer,
                            std::uint32_t TrianglePair::*side) -> std::vector<ExactPenetration> {
      if (!world[in_order.b.index].options.solid) return {};
      std::vector<std::uint32_t> triangles;
      for (const TrianglePair& touch : touching) triangles.push_back(touch.*side);
      BruteForcePenetrations truth =
          find_penetrations_by_brute_force(inner, outer, triangles, world.parallel);
      report.vertex_triangle_pairs_checked += truth.pairs_checked;
      std::span<const Penetration> reported;
      std::span<const std::uint32_t> on_surface;
      for (const PenetrationGroup& group : result.penetration_groups) {
        if (group.a != in_order.a || group.b != in_order.b) continue;
        reported = result.penetrations_of(group);
        on_surface = result.vertices_on_surface_of(group);
      }
      std::vector<ContainedPart> parts;
      for (const ContainedPart& part : result.contained_parts) {
        if (part.inner == in_order.a && part.outer == in_order.b) parts.push_back(part);
      }
      compare_penetrations(in_order, reported, on_surface, parts, truth, report.penetration_differences);
      std::erase_if(truth.vertices, [](const ExactPenetration& p) { return p.where != Containment::inside; });
      report.inside_vertices += truth.vertices.size();
      return std::move(truth.vertices);
    };
    const auto inside_b = inside(pair, a, b, &TrianglePair::a);
    const auto inside_a = inside({pair.b, pair.a}, b, a, &TrianglePair::b);
    verify_curves(pair, {{{&a, inside_b}, {&b, inside_a}}}, result, report.penetration_differences);
  }
};

}  // namespace

VerifyReport verify(const World& world, const Question& question, const DetectResult& result,
                    const CallLimits& limits, const PairShare& share) {
  VerifyReport report;
  auto contacts = result.groups.begin();
  auto impacts = result.continuous_groups.begin();
  auto near = result.proximity_groups.begin();
  std::size_t number = 0, next = share.first;
  for (const ObjectPair& pair : world.all_pairs()) {
    report.stopped = stop_of(limits).stop_requested();
    if (report.stopped) break;
    const auto group_in = [&](auto& place, const auto& groups) {
      const bool is_reported = place != groups.end() && place->a == pair.a && place->b == pair.b;
      return is_reported ? *place++ : ContactGroup{};
    };
    const ContactGroup of_contacts = group_in(contacts, result.groups);
    const ContactGroup of_impacts = group_in(impacts, result.continuous_groups);
    const ContactGroup of_proximity = group_in(near, result.proximity_groups);
    if (number++ != next) continue;
    next += share.stride;
    PairVerification verification{world, question, result, pair, report};
    if (question.has_intersections()) verification.verify_contacts(of_contacts);
    if (question.is_continuous()) verification.verify_impacts(of_impacts);
    if (question.searches(ContactKinds::proximity)) verification.verify_proximity(of_proximity);
    if (question.has_penetration()) verification.verify_penetrations();
    verify_manifolds(pair, {&verification.a, &verification.b}, result, report);
  }
  return report;
}

VerifyReport verify(const Scene& scene, const CallLimits& limits) {
  const auto& inside = SceneAccess::of(scene);
  const Question& question = inside.detection.question();
  if (!inside.is_current()) fail("verify: nothing was detected at the present positions; call detect first");
  if (inside.result.truncated)
    fail("verify: the last detect stopped at max_contacts; call detect with a larger max_contacts first");
  if (question.contacts == ContactKinds::none)
    fail("verify: the last detect searched no contacts, so there is nothing to compare");
  return verify(inside.world, question, inside.result, limits);
}

}  // namespace supple
