#include "mpi/nothing_to_test.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "supple/scene.hpp"

namespace supple::cli {
namespace {

using Vertices = std::set<std::uint32_t>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The element with the most corners that are finite; none of no elements.
template <class Element>
const Element* best_of(const std::vector<Element>& elements, const Vertices& non_finite,
                       const auto& corners) {
  const Element* best = nullptr;
  std::ptrdiff_t most = -1;
  for (const Element& element : elements) {
    const auto vertices = corners(element);
    const auto finite =
        std::ranges::count_if(vertices, [&](std::uint32_t v) { return !non_finite.contains(v); });
    if (finite <= most) continue;
    best = &element;
    most = finite;
    if (finite == std::ssize(vertices)) break;
  }
  return best;
}

/// A mesh that can be tested where that of an object can.
TriangleMesh witness_of(const InputObject& object, const Vertices& non_finite, Vec3d place) {
  TriangleMesh witness;
  if (object.options.self_collision) {
    witness = object.mesh;
    for (const std::uint32_t v : non_finite) witness.positions[v] = {nan, nan, nan};
    return witness;
  }
  const auto add_vertex = [&](bool is_finite) {
    const auto number = static_cast<std::uint32_t>(witness.positions.size());
    constexpr std::array<Vec3d, 4> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    witness.positions.push_back(is_finite ? place + corners[number % 4] : Vec3d{nan, nan, nan});
    return number;
  };
  const auto add = [&](std::uint32_t v) { return add_vertex(!non_finite.contains(v)); };
  const auto all = [](const auto& element) { return element; };
  const TriangleMesh& mesh = object.mesh;
  if (const Triangle* const best = best_of(mesh.triangles, non_finite, all)) {
    const auto finite =
        std::ranges::count_if(*best, [&](std::uint32_t v) { return !non_finite.contains(v); });
    for (std::ptrdiff_t corner = 0; corner < 3; ++corner) add_vertex(corner < finite);
    witness.triangles.push_back({0, 1, 2});
    if (object.options.solid) {
      add_vertex(finite == 3);
      witness.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    }
  }
  if (const auto* const best = best_of(mesh.edges, non_finite, all)) {
    const std::uint32_t first = add((*best)[0]);
    witness.edges.push_back({first, add((*best)[1])});
  }
  if (const auto* const best =
          best_of(mesh.points, non_finite, [](std::uint32_t v) { return std::array{v}; }))
    witness.points.push_back(add(*best));
  return witness;
}

}  // namespace

std::span<const UntestedKind> NothingFound::untested(const DetectResult& result, bool is_step) {
  ContactKinds found = ContactKinds::none;
  if (!result.groups.empty()) found |= ContactKinds::intersection;
  if (!result.continuous_groups.empty()) found |= ContactKinds::continuous;
  if (!result.proximity_groups.empty()) found |= ContactKinds::proximity;
  if (!result.penetration_groups.empty() || !result.contained_parts.empty())
    found |= ContactKinds::penetration;
  untested_.clear();
  if ((found | input_.simulation.scene.contacts) == found) return untested_;
  const auto is_same = [](const NonFiniteVertex& p, const NonFiniteVertex& q) {
    return p.object == q.object && p.vertex == q.vertex;
  };
  if (!has_reasons_ || is_step != is_step_ ||
      !std::ranges::equal(non_finite_, result.non_finite_vertices, is_same)) {
    reasons_ = reasons(result.non_finite_vertices, is_step);
    non_finite_.assign(result.non_finite_vertices.begin(), result.non_finite_vertices.end());
    is_step_ = is_step;
    has_reasons_ = true;
  }
  std::ranges::copy_if(reasons_, std::back_inserter(untested_),
                       [&](const UntestedKind& kind) { return !contains(found, kind.kind); });
  return untested_;
}

std::vector<UntestedKind> NothingFound::reasons(std::span<const NonFiniteVertex> non_finite,
                                                bool is_step) const {
  SceneOptions options = input_.simulation.scene;
  options.threads = 1;
  Scene scene(options);
  std::vector<Vertices> vertices(input_.objects.size());
  for (const NonFiniteVertex& vertex : non_finite) vertices[vertex.object.index].insert(vertex.vertex);
  for (std::size_t i = 0; i < input_.objects.size(); ++i) {
    const InputObject& object = input_.objects[i];
    ObjectOptions small = object.options;
    small.margin = std::min(small.margin, 1e-3);  // far apart, nothing is near
    small.min_separation = 0;
    const TriangleMesh witness = witness_of(object, vertices[i], {3 * static_cast<double>(i), 0, 0});
    const ObjectId id = scene.add(witness, small);
    if (is_step && object.motion && contains(options.contacts, ContactKinds::continuous))
      scene.set_motion(id, witness.positions, witness.positions);
  }
  const DetectResult& result = scene.detect();
  return {result.untested.begin(), result.untested.end()};
}

}  // namespace supple::cli
