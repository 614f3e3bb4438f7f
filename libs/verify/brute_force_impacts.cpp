#include "verify/brute_force.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace supple {
namespace {

ElementPairKind pair_kind(const BoxedElement& p, const BoxedElement& q) {
  for (unsigned kind = 0; kind < 6; ++kind) {
    const auto pair = static_cast<ElementPairKind>(kind);
    if (feature_kinds(pair) == std::array{p.kind, q.kind}) return pair;
  }
  return ElementPairKind::vertex_vertex;
}

}  // namespace

BruteForceImpacts find_impacts_by_brute_force(const PlainObject& a, const PlainObject& b, bool same_object,
                                              const ImpactOptions& options, ElementKinds kinds,
                                              const Parallel& parallel) {
  const BoxedElements of_a = boxed_elements(a), of_b = boxed_elements(b);
  BruteForceImpacts result{{}, element_pairs(of_a, of_b, same_object)};
  const auto decide = [&](const BoxedElement& p, const BoxedElement& q,
                          bool swaps) -> std::optional<TouchingElements> {
    const PlainObject &of_p = swaps ? b : a, &of_q = swaps ? a : b;
    if (!may_touch_by_groups(of_p, p, of_q, q)) return {};
    const std::size_t count = p.kind == FeatureKind::vertex ? 1 : 2;
    const auto points_at = [&](std::vector<Vec3d> PlainObject::*moment) {
      std::array<Vec3d, 4> points;
      for (std::size_t i = 0; i < 4; ++i)
        points[i] = i < count ? (of_p.*moment)[p.vertices[i]] : (of_q.*moment)[q.vertices[i - count]];
      return points;
    };
    const std::array start = points_at(&PlainObject::start), end = points_at(&PlainObject::end);
    const auto first_contact = [&](double distance) {
      return count == 1 ? first_contact_by_algebra(VertexFaceMotion{start, end}, distance)
                        : first_contact_by_algebra(EdgeEdgeMotion{start, end}, distance);
    };
    const std::optional<TimeBracket> time = first_contact(options.min_separation);
    if (!time || time->low - toi_tolerance > options.max_time) return {};
    TouchingElements touching{pair_kind(p, q), p.name, q.name, *time};
    if (swaps) touching = {pair_kind(q, p), q.name, p.name, *time};
    if (same_object && touching.kind == ElementPairKind::vertex_vertex && q.name < p.name)
      std::swap(touching.element_a, touching.element_b);
    touching.may_be_missing = time->high > options.max_time;
    if (options.skip_parting && time->high == 0 && options.min_separation > 0) {
      const std::span points(start);
      const double distance =
          rounded_root(distance_by_algebra(points.first(count), points.subspan(count)).squared);
      // Whether elements that touch at the start part by this share of their distance.
      const auto stays_within = [&](double share) {
        const auto reached = distance > 0 ? first_contact(distance * share) : TimeBracket{};
        return !reached || reached->low > options.max_time;
      };
      // By much more, or a little more, than `ImpactOptions` asks for.
      if (stays_within(1 - 0x1p-11)) return {};
      touching.may_be_missing = touching.may_be_missing || stays_within(1 - 0x1p-9);
    }
    return touching;
  };
  decide_elements(of_a, of_b, same_object, kinds, options.min_separation, parallel, decide, result.touching);
  sort_by_place(result.touching);
  return result;
}

void compare_impacts(const ObjectPair& pair, std::span<const ContinuousContact> reported,
                     std::span<const TouchingElements> truth, ContinuousListing listing,
                     std::span<const ContinuousContact> all_reported,
                     std::vector<ContinuousDifference>& differences) {
  using Fault = ContinuousDifference::Fault;
  // The earliest reported time of each element.
  std::map<std::tuple<ObjectId, FeatureKind, std::array<std::uint32_t, 2>>, double> first_times;
  if (listing == ContinuousListing::all) all_reported = {};
  for (const ContinuousContact& contact : all_reported) {
    const auto [kind_a, kind_b] = feature_kinds(contact.kind);
    for (const auto& element : {std::tuple(contact.object_a, kind_a, contact.element_a),
                                std::tuple(contact.object_b, kind_b, contact.element_b)}) {
      double& time = first_times.try_emplace(element, contact.toi).first->second;
      time = std::min(time, contact.toi);
    }
  }
  // Whether an element has a contact until the pair touches.
  const auto is_known = [&](const TouchingElements& touching, ObjectId object, FeatureKind kind,
                            const std::array<std::uint32_t, 2>& element) {
    const auto known = first_times.find({object, kind, element});
    return known != first_times.end() && known->second <= touching.time.high;
  };
  const auto note = [&](const auto& elements, Fault fault) {
    differences.push_back({pair.a, pair.b, elements.kind, elements.element_a, elements.element_b, fault});
  };
  const auto note_added = [&](const ContinuousContact& found) {
    if (found.certainty == ImpactCertainty::certain) note(found, Fault::added);
  };
  const auto note_missed = [&](const TouchingElements& expected) {
    const auto [kind_a, kind_b] = feature_kinds(expected.kind);
    const bool are_known = is_known(expected, pair.a, kind_a, expected.element_a) &&
                           is_known(expected, pair.b, kind_b, expected.element_b);
    if (!expected.may_be_missing && !are_known) note(expected, Fault::missed);
  };
  const auto compare = [&](const ContinuousContact& found, const TouchingElements& expected) {
    const bool is_certain = found.certainty == ImpactCertainty::certain;
    const bool touching_at_start = expected.time.high == 0;
    const double least = expected.time.high - toi_tolerance_at(expected.time.high);
    if (found.toi > expected.time.low || (touching_at_start && !found.touching_at_start))
      note(expected, Fault::late);
    else if ((is_certain && found.toi < least) || (!touching_at_start && found.touching_at_start))
      note(expected, Fault::early);
  };
  match(
      reported, truth, [](const auto& each) { return place_of(each); }, note_added, note_missed, compare);
}

}  // namespace supple
