#include "scene/brute_force_impacts.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

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

}  // namespace

BruteForceImpacts find_impacts_by_brute_force(const PlainMovingObject& a, const PlainMovingObject& b,
                                              bool same_object, double separation, const Parallel& parallel) {
  using Kind = ElementPairKind;
  const BoxedElements of_a = boxed_elements(a), of_b = boxed_elements(b);
  BruteForceImpacts result;
  result.pairs_checked = element_pairs(of_a, of_b, same_object);
  // `motion_of(p, q)` returns the motion of a pair.
  const auto test_all = [&](Kind kind, const std::vector<BoxedElement>& p_all, const Sweep& q_all,
                            const auto& motion_of) {
    const auto decide = [&](const BoxedElement& p, const BoxedElement& q) -> std::optional<TouchingElements> {
      const std::optional<TimeBracket> time = first_contact_by_algebra(motion_of(p, q), separation);
      if (!time) return {};
      return TouchingElements{kind, p.name, q.name, *time};
    };
    decide_all(p_all, q_all, same_object, kind == Kind::edge_edge, separation, parallel, decide,
               result.touching);
  };
  test_all(Kind::vertex_face, of_a.vertices, Sweep(of_b.faces),
           [&](const BoxedElement& p, const BoxedElement& q) { return vertex_face(a, p, b, q); });
  if (!same_object) {
    test_all(Kind::face_vertex, of_a.faces, Sweep(of_b.vertices),
             [&](const BoxedElement& p, const BoxedElement& q) { return vertex_face(b, q, a, p); });
  }
  test_all(Kind::edge_edge, of_a.edges, Sweep(of_b.edges),
           [&](const BoxedElement& p, const BoxedElement& q) { return edge_edge(a, p, b, q); });
  std::sort(result.touching.begin(), result.touching.end(),
            [](const TouchingElements& p, const TouchingElements& q) { return place_of(p) < place_of(q); });
  return result;
}

void compare_impacts(const ObjectPair& pair, std::span<const ContinuousContact> reported,
                     std::span<const TouchingElements> truth,
                     std::vector<ContinuousDifference>& differences) {
  using Fault = ContinuousDifference::Fault;
  const auto note = [&](const auto& elements, Fault fault) {
    differences.push_back({pair.a, pair.b, elements.kind, elements.element_a, elements.element_b, fault});
  };
  auto found = reported.begin();
  for (const TouchingElements& expected : truth) {
    for (; found != reported.end() && place_of(*found) < place_of(expected); ++found) {
      if (found->certainty == ImpactCertainty::certain) note(*found, Fault::added);
    }
    if (found == reported.end() || place_of(*found) != place_of(expected)) {
      note(expected, Fault::missed);
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
