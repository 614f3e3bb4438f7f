#include "verify/verify.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "answers/search_options.hpp"
#include "core/error.hpp"
#include "core/stop_signal.hpp"
#include "scene/scene_implementation.hpp"
#include "verify/brute_force_contacts.hpp"
#include "verify/brute_force_impacts.hpp"
#include "verify/brute_force_penetrations.hpp"
#include "verify/brute_force_proximity.hpp"
#include "verify/plain_objects.hpp"

namespace supple {
namespace {

class Verification {
 public:
  Verification(const World& world, const Question& question, const DetectResult& result)
      : world_(world), question_(question), result_(result) {}

  VerifyReport run(const CallLimits& limits, const PairShare& share) const;

 private:
  /// These compare the contacts of two objects, or of one object with itself. `group` holds those that were
  /// reported; null when there are none.
  std::vector<TrianglePair> verify_contacts(const ObjectPair& pair, const ContactGroup* group,
                                            VerifyReport& report) const;
  void verify_impacts(const ObjectPair& pair, const ContactGroup* group, VerifyReport& report) const;
  void verify_proximity(const ObjectPair& pair, const ContactGroup* group, VerifyReport& report) const;
  void verify_penetrations(const ObjectPair& pair, std::span<const TrianglePair> touching,
                           VerifyReport& report) const;

  const World& world_;
  const Question& question_;
  const DetectResult& result_;
};

std::vector<TrianglePair> Verification::verify_contacts(const ObjectPair& pair, const ContactGroup* group,
                                                        VerifyReport& report) const {
  const bool same_object = pair.a == pair.b;
  const PlainObject a = plain_object(world_[pair.a.index]);
  const PlainObject b = same_object ? a : plain_object(world_[pair.b.index]);
  std::vector<TrianglePair> truth = intersecting_pairs_by_brute_force(a, b, same_object, world_.parallel);
  std::vector<TrianglePair> reported;
  if (group != nullptr) {
    for (const Contact& contact : result_.contacts_of(*group))
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

void Verification::verify_impacts(const ObjectPair& pair, const ContactGroup* group,
                                  VerifyReport& report) const {
  const bool same_object = pair.a == pair.b;
  const PlainMovingObject a = plain_moving_object(world_[pair.a.index]);
  const PlainMovingObject b = same_object ? a : plain_moving_object(world_[pair.b.index]);
  BruteForceSearch search{question_.impact.impact, question_.impact.kinds};
  search.impact.min_separation = question_.separation_of(world_[pair.a.index], world_[pair.b.index]);
  const BruteForceImpacts truth = find_impacts_by_brute_force(a, b, same_object, search, world_.parallel);
  report.element_pairs_checked += truth.pairs_checked;
  report.touching_element_pairs += truth.touching.size();
  const auto reported =
      group != nullptr ? result_.continuous_contacts_of(*group) : std::span<const ContinuousContact>{};
  compare_impacts(pair, reported, truth.touching, question_.impact.listing, result_.continuous_contacts,
                  report.continuous_differences);
}

void Verification::verify_proximity(const ObjectPair& pair, const ContactGroup* group,
                                    VerifyReport& report) const {
  const bool same_object = pair.a == pair.b;
  const auto at_end = [&](ObjectId id) {
    PlainMovingObject plain = plain_moving_object(world_[id.index]);
    plain.start = plain.end;
    return plain;
  };
  const PlainMovingObject a = at_end(pair.a), b = same_object ? a : at_end(pair.b);
  const BruteForceProximity truth = find_proximity_by_brute_force(
      a, b, same_object,
      reach_of_margins(world_[pair.a.index].options.margin, world_[pair.b.index].options.margin),
      question_.proximity_listing, question_.impact.kinds, world_.parallel);
  report.proximity_pairs_checked += truth.pairs_checked;
  report.near_pairs += truth.near.size();
  const auto reported =
      group != nullptr ? result_.proximity_pairs_of(*group) : std::span<const ProximityPair>{};
  compare_proximity(pair, reported, truth.near, report.proximity_differences);
}

/// Both objects in each other, where the other one is solid.
void Verification::verify_penetrations(const ObjectPair& pair, std::span<const TrianglePair> touching,
                                       VerifyReport& report) const {
  if (pair.a == pair.b) return;
  const PlainObject a = plain_object(world_[pair.a.index]), b = plain_object(world_[pair.b.index]);
  std::vector<ExactPenetration> inside_b, inside_a;
  const auto verify_inside = [&](const ObjectPair& in_order, const PlainObject& inner,
                                 const PlainObject& outer, std::uint32_t TrianglePair::*side,
                                 std::vector<ExactPenetration>& found) {
    if (!world_[in_order.b.index].options.solid) return;
    std::vector<std::uint32_t> triangles;
    for (const TrianglePair& touch : touching) triangles.push_back(touch.*side);
    BruteForcePenetrations truth = find_penetrations_by_brute_force(inner, outer, triangles, world_.parallel);
    report.vertex_triangle_pairs_checked += truth.pairs_checked;
    report.inside_vertices += static_cast<std::uint64_t>(
        std::count_if(truth.vertices.begin(), truth.vertices.end(),
                      [](const ExactPenetration& p) { return p.where == Containment::inside; }));
    std::span<const Penetration> inside;
    std::span<const std::uint32_t> on_surface;
    for (const PenetrationGroup& group : result_.penetration_groups) {
      if (group.a != in_order.a || group.b != in_order.b) continue;
      inside = result_.penetrations_of(group);
      on_surface = result_.vertices_on_surface_of(group);
    }
    std::vector<ContainedPart> parts;
    for (const ContainedPart& part : result_.contained_parts) {
      if (part.inner == in_order.a && part.outer == in_order.b) parts.push_back(part);
    }
    compare_penetrations(in_order, inside, on_surface, parts, truth, report.penetration_differences);
    std::erase_if(truth.vertices, [](const ExactPenetration& p) { return p.where != Containment::inside; });
    found = std::move(truth.vertices);
  };
  verify_inside(pair, a, b, &TrianglePair::a, inside_b);
  verify_inside({pair.b, pair.a}, b, a, &TrianglePair::b, inside_a);
  verify_curves(pair, {{{&a, inside_b}, {&b, inside_a}}}, result_, report.penetration_differences);
}

VerifyReport Verification::run(const CallLimits& limits, const PairShare& share) const {
  VerifyReport report;
  auto contacts = result_.groups.begin();
  auto impacts = result_.continuous_groups.begin();
  auto near = result_.proximity_groups.begin();
  const auto next_of = [](auto& next, const auto& groups, const ObjectPair& pair) {
    const bool reported = next != groups.end() && next->a == pair.a && next->b == pair.b;
    return reported ? &*next++ : nullptr;
  };
  std::size_t number = 0, next = share.first;
  for (const ObjectPair& pair : world_.all_pairs()) {
    report.stopped = stop_of(limits).stop_requested();
    if (report.stopped) break;
    const ContactGroup* const of_contacts = next_of(contacts, result_.groups, pair);
    const ContactGroup* const of_impacts = next_of(impacts, result_.continuous_groups, pair);
    const ContactGroup* const of_proximity = next_of(near, result_.proximity_groups, pair);
    if (number++ != next) continue;
    next += share.stride;
    std::vector<TrianglePair> touching;
    if (question_.has_intersections()) touching = verify_contacts(pair, of_contacts, report);
    if (question_.is_continuous()) verify_impacts(pair, of_impacts, report);
    if (question_.has_proximity()) verify_proximity(pair, of_proximity, report);
    if (question_.has_penetration()) verify_penetrations(pair, touching, report);
    if (!result_.manifolds.empty()) {
      const PlainObject a = plain_object(world_[pair.a.index]), b = plain_object(world_[pair.b.index]);
      supple::verify_manifolds(pair, {&a, &b}, result_, report);
    }
  }
  return report;
}

}  // namespace

VerifyReport verify(const World& world, const Question& question, const DetectResult& result,
                    const CallLimits& limits, const PairShare& share) {
  return Verification(world, question, result).run(limits, share);
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
