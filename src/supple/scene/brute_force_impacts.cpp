#include "scene/brute_force_impacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// A vertex, edge or face: its vertices, its ids, and its exact boxes at both ends of the step.
struct BoxedElement {
  std::array<std::uint32_t, 3> vertices;
  std::array<std::uint32_t, 2> name;
  double start_min[3], start_max[3], end_min[3], end_max[3];

  double sweep_min() const { return std::min(start_min[0], end_min[0]); }
  double sweep_max() const { return std::max(start_max[0], end_max[0]); }
};

/// Appends the element unless a coordinate is not finite.
void append(const PlainMovingObject& object, std::array<std::uint32_t, 3> vertices,
            std::array<std::uint32_t, 2> name, std::vector<BoxedElement>& elements) {
  BoxedElement element{vertices, name, {}, {}, {}, {}};
  const auto corner = [&](const std::vector<Vec3d>& positions, std::size_t i) {
    return positions[vertices[i]];
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_finite(corner(object.start, i)) || !is_finite(corner(object.end, i))) return;
  }
  const auto set_box = [&](const std::vector<Vec3d>& positions, double* min, double* max) {
    for (int axis = 0; axis < 3; ++axis) {
      std::tie(min[axis], max[axis]) =
          std::minmax({corner(positions, 0)[axis], corner(positions, 1)[axis], corner(positions, 2)[axis]});
    }
  };
  set_box(object.start, element.start_min, element.start_max);
  set_box(object.end, element.end_min, element.end_max);
  elements.push_back(element);
}

struct Elements {
  std::vector<BoxedElement> vertices, edges, faces;
};

Elements elements_of(const PlainMovingObject& object) {
  std::vector<std::uint32_t> vertices;
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : object.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      vertices.push_back(t[i]);
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      if (low != high) edges.push_back({low, high});
    }
  }
  const auto keep_distinct = [](auto& items) {
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
  };
  keep_distinct(vertices);
  keep_distinct(edges);
  Elements elements;
  for (const std::uint32_t v : vertices) append(object, {v, v, v}, {v, v}, elements.vertices);
  for (const auto& [v, w] : edges) append(object, {v, w, w}, {v, w}, elements.edges);
  for (std::uint32_t f = 0; f < object.triangles.size(); ++f) {
    append(object, object.triangles[f], {f, f}, elements.faces);
  }
  return elements;
}

/// Whether p and q are farther apart than the separation along some axis, on the same side at both ends. The
/// factor exceeds the rounding of the differences.
bool stay_apart(const BoxedElement& p, const BoxedElement& q, double separation) {
  const double least = separation * (1 + 0x1p-50);
  for (int axis = 0; axis < 3; ++axis) {
    if (p.start_min[axis] - q.start_max[axis] > least && p.end_min[axis] - q.end_max[axis] > least)
      return true;
    if (q.start_min[axis] - p.start_max[axis] > least && q.end_min[axis] - p.end_max[axis] > least)
      return true;
  }
  return false;
}

bool share_vertex(const BoxedElement& p, const BoxedElement& q) {
  return std::any_of(p.vertices.begin(), p.vertices.end(), [&](std::uint32_t vertex) {
    return std::find(q.vertices.begin(), q.vertices.end(), vertex) != q.vertices.end();
  });
}

/// Elements of b sorted by their least x. `reach` is, for each, the greatest x of the elements up to it:
/// where that is less than the least x of another element, none of the elements up to here comes near it.
struct Sweep {
  std::vector<BoxedElement> elements;
  std::vector<double> reach;

  explicit Sweep(std::vector<BoxedElement> unsorted) : elements(std::move(unsorted)) {
    std::sort(elements.begin(), elements.end(), [](const BoxedElement& p, const BoxedElement& q) {
      return std::tuple(p.sweep_min(), p.name) < std::tuple(q.sweep_min(), q.name);
    });
    for (const BoxedElement& q : elements)
      reach.push_back(reach.empty() ? q.sweep_max() : std::max(reach.back(), q.sweep_max()));
  }
};

/// Calls `decide(p, q)` for all pairs that may come near each other and collects the touching ones.
template <class Decide>
void test_all(const std::vector<BoxedElement>& a, const Sweep& b, bool same_object, double separation,
              const Parallel& parallel, ElementPairKind kind, Decide&& decide,
              std::vector<TouchingElements>& touching) {
  std::vector<std::vector<TouchingElements>> found(parallel.worker_count());
  const double margin = separation * (1 + 0x1p-50);
  parallel.for_ranges(a.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end; ++i) {
      const BoxedElement& p = a[i];
      // Widened by more than the sums can lose.
      const double slack = (std::abs(p.sweep_min()) + std::abs(p.sweep_max()) + margin) * 0x1p-50;
      const double low = p.sweep_min() - margin - slack, high = p.sweep_max() + margin + slack;
      const auto first = std::lower_bound(b.reach.begin(), b.reach.end(), low) - b.reach.begin();
      for (auto q = b.elements.begin() + first; q != b.elements.end() && q->sweep_min() <= high; ++q) {
        if (same_object && share_vertex(p, *q)) continue;
        if (same_object && kind == ElementPairKind::edge_edge && q->name <= p.name) continue;
        if (stay_apart(p, *q, separation)) continue;
        if (const std::optional<TimeBracket> time = decide(p, *q))
          found[worker].push_back({kind, p.name, q->name, *time});
      }
    }
  });
  const auto from = static_cast<std::ptrdiff_t>(touching.size());
  for (const auto& part : found) touching.insert(touching.end(), part.begin(), part.end());
  std::sort(touching.begin() + from, touching.end(),
            [](const TouchingElements& p, const TouchingElements& q) {
              return std::tie(p.element_a, p.element_b) < std::tie(q.element_a, q.element_b);
            });
}

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
  const Elements of_a = elements_of(a), of_b = elements_of(b);
  const std::uint64_t edges_a = of_a.edges.size(), edges_b = of_b.edges.size();
  BruteForceImpacts result;
  result.pairs_checked = of_a.vertices.size() * std::uint64_t{of_b.faces.size()};
  test_all(
      of_a.vertices, Sweep(of_b.faces), same_object, separation, parallel, Kind::vertex_face,
      [&](const BoxedElement& p, const BoxedElement& q) {
        return first_contact_by_algebra(vertex_face(a, p, b, q), separation);
      },
      result.touching);
  if (!same_object) {
    result.pairs_checked += of_a.faces.size() * std::uint64_t{of_b.vertices.size()};
    test_all(
        of_a.faces, Sweep(of_b.vertices), false, separation, parallel, Kind::face_vertex,
        [&](const BoxedElement& p, const BoxedElement& q) {
          return first_contact_by_algebra(vertex_face(b, q, a, p), separation);
        },
        result.touching);
  }
  result.pairs_checked +=
      same_object ? edges_a * (edges_a - std::min<std::uint64_t>(edges_a, 1)) / 2 : edges_a * edges_b;
  test_all(
      of_a.edges, Sweep(of_b.edges), same_object, separation, parallel, Kind::edge_edge,
      [&](const BoxedElement& p, const BoxedElement& q) {
        return first_contact_by_algebra(edge_edge(a, p, b, q), separation);
      },
      result.touching);
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
