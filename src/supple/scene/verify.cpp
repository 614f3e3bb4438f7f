#include <algorithm>
#include <iterator>

#include "core/error.hpp"
#include "scene/brute_force_contacts.hpp"
#include "scene/brute_force_impacts.hpp"
#include "scene/brute_force_penetrations.hpp"
#include "scene/brute_force_proximity.hpp"
#include "scene/plain_objects.hpp"
#include "scene/scene_implementation.hpp"

namespace supple {
/// All pairs of objects that may collide by their groups and filters, whatever their volumes.
std::vector<ObjectPair> Scene::Implementation::pairs_to_verify() const {
  std::vector<ObjectPair> pairs;
  for (const ObjectId a : objects()) {
    if (slots_[a.index].object->options.self_collision) pairs.push_back({a, a});
    for (const ObjectId b : objects()) {
      if (a < b && may_pair({a.index, b.index})) pairs.push_back({a, b});
    }
  }
  return pairs;
}

std::vector<TrianglePair> Scene::Implementation::verify_contacts(const ObjectPair& pair,
                                                                 const ContactGroup* group,
                                                                 VerifyReport& report) const {
  const bool same_object = pair.a == pair.b;
  const PlainObject a = plain_object(*slots_[pair.a.index].object);
  const PlainObject b = same_object ? a : plain_object(*slots_[pair.b.index].object);
  std::vector<TrianglePair> truth = intersecting_pairs_by_brute_force(a, b, same_object, parallel);
  std::vector<TrianglePair> reported;
  if (group != nullptr) {
    for (const Contact& contact : result.contacts_of(*group))
      reported.push_back({contact.triangle_a, contact.triangle_b});
  }
  const std::uint64_t count_a = a.triangles.size();
  report.triangle_pairs_checked += same_object ? count_a * (count_a - std::min<std::uint64_t>(count_a, 1)) / 2
                                               : count_a * b.triangles.size();
  report.intersecting_pairs += truth.size();
  const auto note = [&](const std::vector<TrianglePair>& from, const std::vector<TrianglePair>& without,
                        bool missed) {
    std::vector<TrianglePair> difference;
    std::set_difference(from.begin(), from.end(), without.begin(), without.end(),
                        std::back_inserter(difference));
    for (const TrianglePair& p : difference) report.differences.push_back({pair.a, pair.b, p.a, p.b, missed});
  };
  note(truth, reported, true);
  note(reported, truth, false);
  return truth;
}

void Scene::Implementation::verify_impacts(const ObjectPair& pair, const ContactGroup* group,
                                           VerifyReport& report) const {
  const bool same_object = pair.a == pair.b;
  const PlainMovingObject a = plain_moving_object(*slots_[pair.a.index].object);
  const PlainMovingObject b = same_object ? a : plain_moving_object(*slots_[pair.b.index].object);
  BruteForceSearch search{question_.impact.impact, question_.impact.kinds};
  search.impact.min_separation = separation_of({pair.a.index, pair.b.index});
  const BruteForceImpacts truth = find_impacts_by_brute_force(a, b, same_object, search, parallel);
  report.element_pairs_checked += truth.pairs_checked;
  report.touching_element_pairs += truth.touching.size();
  const auto reported =
      group != nullptr ? result.continuous_contacts_of(*group) : std::span<const ContinuousContact>{};
  compare_impacts(pair, reported, truth.touching, question_.impact.listing, result.continuous_contacts,
                  report.continuous_differences);
}

void Scene::Implementation::verify_proximity(const ObjectPair& pair, const ContactGroup* group,
                                             VerifyReport& report) const {
  const bool same_object = pair.a == pair.b;
  const auto at_end = [&](ObjectId id) {
    PlainMovingObject plain = plain_moving_object(*slots_[id.index].object);
    plain.start = plain.end;
    return plain;
  };
  const PlainMovingObject a = at_end(pair.a), b = same_object ? a : at_end(pair.b);
  const BruteForceProximity truth =
      find_proximity_by_brute_force(a, b, same_object, reach_of({pair.a.index, pair.b.index}),
                                    question_.proximity_listing, question_.impact.kinds, parallel);
  report.proximity_pairs_checked += truth.pairs_checked;
  report.near_pairs += truth.near.size();
  const auto reported =
      group != nullptr ? result.proximity_pairs_of(*group) : std::span<const ProximityPair>{};
  compare_proximity(pair, reported, truth.near, report.proximity_differences);
}

/// Both objects in each other, where the other one is solid.
void Scene::Implementation::verify_penetrations(const ObjectPair& pair,
                                                std::span<const TrianglePair> touching,
                                                VerifyReport& report) const {
  if (pair.a == pair.b) return;
  const PlainObject a = plain_object(*slots_[pair.a.index].object),
                    b = plain_object(*slots_[pair.b.index].object);
  const auto verify_inside = [&](const ObjectPair& in_order, const PlainObject& inner,
                                 const PlainObject& outer, std::uint32_t TrianglePair::*side) {
    if (!slots_[in_order.b.index].object->options.solid) return;
    std::vector<std::uint32_t> triangles;
    for (const TrianglePair& touch : touching) triangles.push_back(touch.*side);
    const BruteForcePenetrations truth = find_penetrations_by_brute_force(inner, outer, triangles, parallel);
    report.vertex_triangle_pairs_checked += truth.pairs_checked;
    report.inside_vertices += static_cast<std::uint64_t>(
        std::count_if(truth.vertices.begin(), truth.vertices.end(),
                      [](const ExactPenetration& p) { return p.where == Containment::inside; }));
    std::span<const Penetration> inside;
    std::span<const std::uint32_t> on_surface;
    for (const PenetrationGroup& group : result.penetration_groups) {
      if (group.a != in_order.a || group.b != in_order.b) continue;
      inside = result.penetrations_of(group);
      on_surface = result.vertices_on_surface_of(group);
    }
    std::vector<ContainedPart> parts;
    for (const ContainedPart& part : result.contained_parts) {
      if (part.inner == in_order.a && part.outer == in_order.b) parts.push_back(part);
    }
    compare_penetrations(in_order, inside, on_surface, parts, truth, question_.depths,
                         report.penetration_differences);
  };
  verify_inside(pair, a, b, &TrianglePair::a);
  verify_inside({pair.b, pair.a}, b, a, &TrianglePair::b);
}

VerifyReport Scene::Implementation::verify(const CallLimits& limits) const {
  if (!detected_) fail("verify: nothing was detected at the present positions; call detect first");
  if (result.truncated)
    fail("verify: the last detect stopped at max_contacts; call detect with a larger max_contacts first");
  if (question_.contacts == ContactKinds::none)
    fail("verify: the last detect searched no contacts, so there is nothing to compare");
  VerifyReport report;
  auto contacts = result.groups.begin();
  auto impacts = result.continuous_groups.begin();
  auto near = result.proximity_groups.begin();
  const auto next_of = [](auto& next, const auto& groups, const ObjectPair& pair) {
    const bool reported = next != groups.end() && next->a == pair.a && next->b == pair.b;
    return reported ? &*next++ : nullptr;
  };
  for (const ObjectPair& pair : pairs_to_verify()) {
    report.stopped = stop_of(limits).stop_requested();
    if (report.stopped) break;
    const ContactGroup* const of_contacts = next_of(contacts, result.groups, pair);
    const ContactGroup* const of_impacts = next_of(impacts, result.continuous_groups, pair);
    const ContactGroup* const of_proximity = next_of(near, result.proximity_groups, pair);
    std::vector<TrianglePair> touching;
    if (question_.has_intersections()) touching = verify_contacts(pair, of_contacts, report);
    if (question_.is_continuous()) verify_impacts(pair, of_impacts, report);
    if (question_.has_proximity()) verify_proximity(pair, of_proximity, report);
    if (question_.has_penetration()) verify_penetrations(pair, touching, report);
  }
  return report;
}

}  // namespace supple
