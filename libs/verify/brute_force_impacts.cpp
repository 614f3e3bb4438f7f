#include "verify/brute_force_impacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "verify/algebra/distance_algebra.hpp"

namespace supple {
namespace {

VertexFaceMotion vertex_face(const PlainMovingObject& a, const BoxedElement& vertex,
                             const PlainMovingObject& b, const BoxedElement& face) {
  const auto& [f0, f1, f2] = face.vertices;
  const std::uint32_t v = vertex.vertices[0];
  return {{a.start[v], b.start[f0], b.start[f1], b.start[f2]}, {a.end[v], b.end[f0], b.end[f1], b.end[f2]}};
}

EdgeEdgeMotion edge_edge(const PlainMovingObject& a, const BoxedElement& p, const PlainMovingObject& b,
                         const BoxedElement& q) {
  const std::uint32_t p0 = p.vertices[0], p1 = p.vertices[1], q0 = q.vertices[0], q1 = q.vertices[1];
  return {{a.start[p0], a.start[p1], b.start[q0], b.start[q1]}, {a.end[p0], a.end[p1], b.end[q0], b.end[q1]}};
}

auto place_of(const ContinuousContact& contact) {
  return std::tie(contact.kind, contact.element_a, contact.element_b);
}
auto place_of(const TouchingElements& touching) {
  return std::tie(touching.kind, touching.element_a, touching.element_b);
}

ElementPairKind pair_kind(const BoxedElement& p, const BoxedElement& q) {
  for (unsigned kind = 0; kind < 6; ++kind) {
    const auto pair = static_cast<ElementPairKind>(kind);
    if (feature_kinds(pair) == std::array{p.kind, q.kind}) return pair;
  }
  return ElementPairKind::vertex_vertex;
}

/// Whether elements that touch at the start part by much more, or a little more, than `ImpactOptions` asks
/// for.
template <class Motion>
std::array<bool, 2> part(const Motion& motion, const ImpactOptions& options, std::span<const Vec3d> first,
                         std::span<const Vec3d> second) {
  const double distance = rounded_root(distance_by_algebra(first, second).squared);
  if (!(distance > 0)) return {false, false};
  const auto stays_within = [&](double share) {
    const auto time = first_contact_by_algebra(motion, distance * share);
    return !time || time->low > options.max_time;
  };
  return {stays_within(1 - 0x1p-11), stays_within(1 - 0x1p-9)};
}

}  // namespace

BruteForceImpacts find_impacts_by_brute_force(const PlainMovingObject& a, const PlainMovingObject& b,
                                              bool same_object, const BruteForceSearch& search,
                                              const Parallel& parallel) {
  const ImpactOptions& options = search.impact;
  const BoxedElements of_a = boxed_elements(a), of_b = boxed_elements(b);
  BruteForceImpacts result;
  result.pairs_checked = element_pairs(of_a, of_b, same_object);
  // `motion_of(p, q)` returns the motion of a pair.
  const auto test_all = [&](bool are_edges, const std::vector<BoxedElement>& p_all, const Sweep& q_all,
                            const auto& motion_of) {
    const auto decide = [&](const BoxedElement& p, const BoxedElement& q) -> std::optional<TouchingElements> {
      if (!may_touch_by_groups(a, p, b, q)) return {};
      const auto motion = motion_of(p, q);
      const std::optional<TimeBracket> time = first_contact_by_algebra(motion, options.min_separation);
      if (!time || time->low - toi_tolerance > options.max_time) return {};
      TouchingElements touching{pair_kind(p, q), p.name, q.name, *time};
      if (same_object && touching.kind == ElementPairKind::vertex_vertex && q.name < p.name)
        std::swap(touching.element_a, touching.element_b);
      touching.may_be_missing = time->high > options.max_time;
      if (options.skip_parting && time->high == 0 && options.min_separation > 0) {
        const std::size_t count = are_edges ? 2 : 1;
        const auto [surely, maybe] = part(motion, options, std::span(motion.start).first(count),
                                          std::span(motion.start).subspan(count));
        if (surely) return {};
        touching.may_be_missing = touching.may_be_missing || maybe;
      }
      return touching;
    };
    decide_all(p_all, q_all, same_object, are_edges, options.min_separation, parallel, decide,
               result.touching);
  };
  if (search.kinds != ElementKinds::edge_edge) {
    test_all(false, of_a.vertices, Sweep(of_b.faces),
             [&](const BoxedElement& p, const BoxedElement& q) { return vertex_face(a, p, b, q); });
    if (!same_object) {
      test_all(false, of_a.faces, Sweep(of_b.vertices),
               [&](const BoxedElement& p, const BoxedElement& q) { return vertex_face(b, q, a, p); });
    }
  }
  if (search.kinds != ElementKinds::vertex_face) {
    test_all(true, of_a.edges, Sweep(of_b.edges),
             [&](const BoxedElement& p, const BoxedElement& q) { return edge_edge(a, p, b, q); });
  }
  std::sort(result.touching.begin(), result.touching.end(),
            [](const TouchingElements& p, const TouchingElements& q) { return place_of(p) < place_of(q); });
  const auto same = [](const auto& p, const auto& q) { return place_of(p) == place_of(q); };
  result.touching.erase(std::unique(result.touching.begin(), result.touching.end(), same),
                        result.touching.end());
  return result;
}

namespace {

/// The earliest reported time of each element.
class FirstTimes {
 public:
  explicit FirstTimes(std::span<const ContinuousContact> reported) {
    for (const ContinuousContact& contact : reported) {
      const auto [kind_a, kind_b] = feature_kinds(contact.kind);
      for (const Element& element : {Element{contact.object_a, kind_a, contact.element_a},
                                     Element{contact.object_b, kind_b, contact.element_b}}) {
        const auto [known, is_new] = times_.try_emplace(element, contact.toi);
        known->second = std::min(known->second, contact.toi);
      }
    }
  }

  /// Whether both elements have a contact until the pair touches.
  bool are_known(const ObjectPair& objects, const TouchingElements& pair) const {
    const auto [kind_a, kind_b] = feature_kinds(pair.kind);
    const auto is_known = [&](const Element& element) {
      const auto known = times_.find(element);
      return known != times_.end() && known->second <= pair.time.high;
    };
    return is_known({objects.a, kind_a, pair.element_a}) && is_known({objects.b, kind_b, pair.element_b});
  }

 private:
  using Element = std::tuple<ObjectId, FeatureKind, std::array<std::uint32_t, 2>>;
  std::map<Element, double> times_;
};

}  // namespace

void compare_impacts(const ObjectPair& pair, std::span<const ContinuousContact> reported,
                     std::span<const TouchingElements> truth, ContinuousListing listing,
                     std::span<const ContinuousContact> all_reported,
                     std::vector<ContinuousDifference>& differences) {
  using Fault = ContinuousDifference::Fault;
  const FirstTimes first_times(listing == ContinuousListing::first ? all_reported
                                                                   : std::span<const ContinuousContact>{});
  const auto note = [&](const auto& elements, Fault fault) {
    differences.push_back({pair.a, pair.b, elements.kind, elements.element_a, elements.element_b, fault});
  };
  auto found = reported.begin();
  for (const TouchingElements& expected : truth) {
    for (; found != reported.end() && place_of(*found) < place_of(expected); ++found) {
      if (found->certainty == ImpactCertainty::certain) note(*found, Fault::added);
    }
    if (found == reported.end() || place_of(*found) != place_of(expected)) {
      if (!expected.may_be_missing && !first_times.are_known(pair, expected)) note(expected, Fault::missed);
      continue;
    }
    const bool is_certain = found->certainty == ImpactCertainty::certain;
    const bool touching_at_start = expected.time.high == 0;
    const double least = expected.time.high - toi_tolerance_at(expected.time.high);
    if (found->toi > expected.time.low || (touching_at_start && !found->touching_at_start))
      note(expected, Fault::late);
    else if ((is_certain && found->toi < least) || (!touching_at_start && found->touching_at_start))
      note(expected, Fault::early);
    ++found;
  }
  for (; found != reported.end(); ++found) {
    if (found->certainty == ImpactCertainty::certain) note(*found, Fault::added);
  }
}

}  // namespace supple
