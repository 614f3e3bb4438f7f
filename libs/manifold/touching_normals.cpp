#include "manifold/touching_normals.hpp"

#include <algorithm>
#include <numeric>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Sines of smaller angles are rounding.
constexpr double least_sine = 0x1p-30;

Vec3d direction_of(const Vec3d& v) {
  const double length = scaled_norm(v);
  return length > 0 ? v / length : Vec3d{};
}

void add_once(const Vec3d& direction, std::vector<Vec3d>& directions) {
  const auto is_same = [&](const Vec3d& other) { return norm(direction - other) < least_sine; };
  if (std::ranges::none_of(directions, is_same)) directions.push_back(direction);
}

/// Visits the triangles around a feature.
template <class Visit>
void for_each_triangle(ManifoldObject& object, const FeatureName& feature, const Visit& visit) {
  if (feature.kind == FeatureKind::face) return visit(feature.first);
  for (const std::uint32_t id : object.around(feature.first)) {
    if (std::ranges::count(object.surface.triangle(id), feature.last) > 0) visit(id);
  }
}

}  // namespace

/// The smallest feature of the element that has the point, but for rounding.
FeatureName TouchingNormals::feature_of(ManifoldObject& object, const ProximityPair& pair, bool is_a) {
  const auto& element = is_a ? pair.element_a : pair.element_b;
  const auto& weights = is_a ? pair.barycentric_a : pair.barycentric_b;
  const Vec3d& point = is_a ? pair.point_a : pair.point_b;
  Triangle vertices{element[0], element[1], element[1]};
  if ((is_a ? pair.kind_a : pair.kind_b) == FeatureKind::face) vertices = object.surface.triangle(element[0]);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d position = object.surface.position(vertices[k]);
    rounding_ = std::max(rounding_, 0x1p-40 * largest_magnitude(position));
    if (weights[k] * largest_magnitude(position - point) > rounding_ || (kept == 0 && weights[k] > 0.5))
      vertices[kept++] = vertices[k];
  }
  if (kept == 3) return {FeatureKind::face, element[0], element[0]};
  const auto [first, last] = std::minmax(vertices[0], vertices[kept == 2 ? 1 : 0]);
  return {kept == 2 ? FeatureKind::edge : FeatureKind::vertex, first, last};
}

void TouchingNormals::list(ManifoldObject& object, const FeatureName& feature, const Vec3d& point,
                           Around& around) const {
  const SurfaceView& surface = object.surface;
  around = {feature,        std::move(around.corners), std::move(around.edges), std::move(around.normals), {},
            object.is_solid};
  for (std::vector<Vec3d>* const vectors : {&around.corners, &around.edges, &around.normals})
    vectors->clear();
  const auto add_triangle = [&](std::uint32_t id) {
    for (const Vec3d& corner : surface.corners(id)) around.corners.push_back(corner - point);
    const Vec3d normal = unit_normal(surface.corners(id));
    if (normal != Vec3d{}) add_once(normal, around.normals);
  };
  const auto add_edge = [&](std::uint32_t from, std::uint32_t to) {
    around.corners.push_back(surface.position(to) - point);
    if (from != to) around.edges.push_back(direction_of(surface.position(to) - surface.position(from)));
  };
  if (feature.kind != FeatureKind::face) add_edge(feature.first, feature.last);
  if (feature.kind == FeatureKind::edge) around.corners.push_back(surface.position(feature.first) - point);
  for_each_triangle(object, feature, [&](std::uint32_t id) {
    add_triangle(id);
    for (const std::uint32_t corner : surface.triangle(id)) {
      if (feature.kind == FeatureKind::vertex) add_edge(feature.first, corner);
    }
  });
  for (const Vec3d& normal : around.normals) around.outward += normal;
}

/// Whether a surface is on the side of a plane to which the normal points, and the inside of a solid, too.
bool TouchingNormals::is_before(const Around& around, const Vec3d& normal) const {
  const auto is_before_plane = [&](const Vec3d& corner) { return dot(corner, normal) >= -rounding_; };
  const auto looks_back = [&](const Vec3d& face) { return dot(face, normal) < -least_sine; };
  return std::ranges::all_of(around.corners, is_before_plane) &&
         (!around.is_solid || std::ranges::any_of(around.normals, looks_back));
}

void TouchingNormals::add_if_apart(const Vec3d& normal) {
  if (is_before(a_, normal) && is_before(b_, -normal)) add_once(normal, normals_);
}

std::span<const Vec3d> TouchingNormals::find(const ProximityPair& pair, ManifoldObject& a,
                                             ManifoldObject& b) {
  rounding_ = 0x1p-40 * std::max(largest_magnitude(pair.point_a), largest_magnitude(pair.point_b));
  list(a, feature_of(a, pair, true), pair.point_a, a_);
  list(b, feature_of(b, pair, false), pair.point_b, b_);
  normals_.clear();
  // An open surface looks at the other one.
  if (dot(a_.outward, b_.outward) > 0 && (a.object->open_edge() || b.object->open_edge())) {
    Around& turned = a.object->open_edge() ? a_ : b_;
    for (Vec3d& normal : turned.normals) normal = -normal;
    turned.outward = -turned.outward;
  }
  // First as if all surfaces look outwards, then as if they look inwards.
  for (const double sign : {1.0, -1.0}) {
    if (!normals_.empty()) break;
    for (const Vec3d& normal : b_.normals) add_if_apart(sign * normal);
    for (const Vec3d& normal : a_.normals) add_if_apart(-sign * normal);
  }
  for (const Vec3d& edge : std::span(a_.edges).first(normals_.empty() ? a_.edges.size() : 0)) {
    for (const Vec3d& other : b_.edges) {
      const Vec3d across = cross(edge, other);
      if (norm(across) < least_sine) continue;
      const Vec3d normal = (dot(across, b_.outward - a_.outward) < 0 ? -1 : 1) * direction_of(across);
      const std::size_t count = normals_.size();
      add_if_apart(normal);
      if (normals_.size() == count) add_if_apart(-normal);
    }
  }
  if (normals_.size() > 1)
    normals_.assign(1, direction_of(std::accumulate(normals_.begin(), normals_.end(), Vec3d{})));
  if (!normals_.empty()) return normals_;
  for (const Vec3d& normal : b_.normals) {
    if (is_before(a_, normal)) add_once(normal, normals_);
  }
  for (const Vec3d& normal : a_.normals) {
    if (is_before(b_, normal)) add_once(-normal, normals_);
  }
  if (!normals_.empty()) return normals_;
  // Points of no triangle have no side; surfaces with the same vertices may lie on each other, bent.
  const Vec3d out_of_a = direction_of(a_.outward), out_of_b = direction_of(b_.outward);
  const auto is_vertex = [](const Around& around) { return around.feature.kind == FeatureKind::vertex; };
  if (a_.normals.empty() && b_.normals.empty())
    normals_.push_back(pair.normal);
  else if ((is_vertex(a_) || is_vertex(b_)) && dot(out_of_a, out_of_b) <= -0.9)
    normals_.push_back(direction_of(out_of_b - out_of_a));
  return normals_;
}

bool TouchingNormals::starts_inside(const ProximityPair& pair, ManifoldObject& a, ManifoldObject& b) {
  const auto starts_in = [](ManifoldObject& object, const FeatureName& feature, const Vec3d& way) {
    bool has_face = false, look_away = true;
    for_each_triangle(object, feature, [&](std::uint32_t id) {
      has_face = true;
      look_away = look_away && dot(unit_normal(object.surface.corners(id)), way) < 0;
    });
    return has_face && look_away;
  };
  rounding_ = 0;
  return (a.is_solid && starts_in(a, feature_of(a, pair, true), -pair.normal)) ||
         (b.is_solid && starts_in(b, feature_of(b, pair, false), pair.normal));
}

}  // namespace supple
