#include "objects/home_object.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/object_octree.hpp"
#include "supple/option_descriptions.hpp"
#include "world/checked_elements.hpp"

namespace supple {
namespace {

std::string named(ObjectId id, const ObjectOptions& options) {
  return options.name.empty() ? "object " + std::to_string(id.index) : options.name;
}

void check_ascending(std::span<const std::uint32_t> ids, std::size_t count, const std::string& what) {
  if (ids.size() != count)
    fail(what + ": " + std::to_string(ids.size()) + " numbers for " + std::to_string(count) +
         "; give one for each");
  for (std::size_t i = 1; i < ids.size(); ++i) {
    if (ids[i - 1] < ids[i]) continue;
    fail(what + ": number " + std::to_string(i) + " is " + std::to_string(ids[i]) + " after " +
         std::to_string(ids[i - 1]) + "; give them ascending, each once");
  }
}

/// Faces, then edges and points of no triangle, as in a world.
std::vector<Triangle> checked_elements(const TrianglesView& triangles, std::size_t vertex_count,
                                       const ObjectOptions& options) {
  std::vector<Triangle> elements = checked_triangles(options.name, vertex_count, triangles, Parallel(1));
  std::vector<Triangle> others = checked_extra_elements(vertex_count, options);
  sort_once(others);
  elements.insert(elements.end(), others.begin(), others.end());
  return elements;
}

/// More elements could have more corners than 16 bits can count.
constexpr std::uint32_t most_elements = 65535 / 3;

template <class Scalar>
void write_vertices(const std::vector<Scalar>& xyz, std::span<const std::uint32_t> vertices, Writer& to) {
  for (const std::uint32_t v : vertices)
    to.put(std::array<Scalar, 3>{xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]});
}

}  // namespace

void Coordinates::assign(const PositionsView& positions) {
  is_double = positions.is_double();
  doubles.resize(is_double ? 3 * positions.size() : 0);
  floats.resize(is_double ? 0 : 3 * positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t at = 3 * i + static_cast<std::size_t>(axis);
      if (is_double) {
        doubles[at] = positions.get<double>(i)[axis];
      } else {
        floats[at] = positions.get<float>(i)[axis];
      }
    }
  }
}

HomeObject::HomeObject(ObjectId object_id, const PositionsView& positions, const TrianglesView& triangles,
                       const ObjectPart* part, const ObjectOptions& object_options,
                       std::uint32_t cluster_triangles, std::uint32_t addition_number)
    : id(object_id),
      addition(addition_number),
      options(object_options),
      is_part_(part != nullptr),
      vertex_count_(positions.size()) {
  options.name = named(id, options);
  check(options);
  if (options.weld || !options.same_vertex.empty())
    fail(options.name + ": a distributed scene does not weld; weld the mesh before it is added");
  std::span<const std::uint32_t> face_ids;
  if (part != nullptr) {
    check_ascending(part->vertices, positions.size(), options.name + ": ObjectPart::vertices");
    check_ascending(part->triangles, triangles.size(), options.name + ": ObjectPart::triangles");
    vertex_ids_.assign(part->vertices.begin(), part->vertices.end());
    face_ids = part->triangles;
  }
  const std::vector<Triangle> elements = checked_elements(triangles, positions.size(), options);
  const auto face_count = static_cast<std::uint32_t>(triangles.size());
  end_.assign(positions);
  // Neighbours in space are neighbours in the order of an octree.
  const ObjectOctree octree(positions, elements, {}, BoundingVolume::aabb, SphereFit{});
  const std::span<const std::uint32_t> order = octree.triangle_ids();
  const std::size_t most = std::min(cluster_triangles, most_elements);
  const std::size_t count = (order.size() + most - 1) / most;
  clusters.reserve(count);
  constexpr std::uint32_t unplaced = ~std::uint32_t{0};
  std::vector<std::uint32_t> place_of(vertex_count_, unplaced);  // in the cluster
  for (std::size_t c = 0; c < count; ++c) {
    Cluster& cluster = clusters.emplace_back();
    const std::size_t first = order.size() * c / count, end = order.size() * (c + 1) / count;
    std::vector<std::uint32_t> ids(order.begin() + static_cast<std::ptrdiff_t>(first),
                                   order.begin() + static_cast<std::ptrdiff_t>(end));
    std::sort(ids.begin(), ids.end());
    for (const std::uint32_t e : ids) {
      for (const std::uint32_t v : elements[e]) {
        if (std::exchange(place_of[v], 0) != 0) cluster.vertices.push_back(v);
      }
    }
    cluster.vertices.shrink_to_fit();
    std::sort(cluster.vertices.begin(), cluster.vertices.end());
    for (std::uint32_t i = 0; i < cluster.vertices.size(); ++i) place_of[cluster.vertices[i]] = i;
    cluster.elements.reserve(ids.size());
    cluster.faces.reserve(ids.size());
    for (const std::uint32_t e : ids) {
      auto& corners = cluster.elements.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) corners[i] = static_cast<std::uint16_t>(place_of[elements[e][i]]);
      if (e < face_count) cluster.faces.push_back(face_ids.empty() ? e : face_ids[e]);
    }
    for (const std::uint32_t v : cluster.vertices) place_of[v] = unplaced;
    cluster.work = static_cast<double>(cluster.elements.size());
  }
  // They are in the clusters now.
  options.edges = {};
  options.points = {};
}

void HomeObject::check_count(const PositionsView& positions, const char* call) const {
  if (positions.size() == vertex_count_) return;
  fail(std::string(call) + ": " + std::to_string(positions.size()) + " positions for " + options.name +
       ", which has " + std::to_string(vertex_count_) + " vertices; give one for each vertex");
}

void HomeObject::set_positions(const PositionsView& positions) {
  if (options.is_static) fail("set_positions: " + options.name + " is static and cannot move");
  check_count(positions, "set_positions");
  end_.assign(positions);
  start_ = {};
  ++version_;
}

void HomeObject::set_motion(const PositionsView& from, const PositionsView& to) {
  if (options.is_static) fail("set_motion: " + options.name + " is static and cannot move");
  check_count(from, "set_motion");
  check_count(to, "set_motion");
  if (from.is_double() != to.is_double())
    fail("set_motion: one end of the path is float, the other double; give both in one precision");
  start_.assign(from);
  end_.assign(to);
  ++version_;
}

void HomeObject::set_vertex_groups(std::span<const std::uint32_t> groups,
                                   std::span<const std::uint32_t> masks) {
  for (const std::size_t given : {groups.size(), masks.size()}) {
    if (given == vertex_count_ || (groups.empty() && masks.empty())) continue;
    fail("set_vertex_groups: " + std::to_string(given) + " numbers for " + options.name + ", which has " +
         std::to_string(vertex_count_) + " vertices; give a group and a mask for each vertex");
  }
  groups_.assign(groups.begin(), groups.end());
  masks_.assign(masks.begin(), masks.end());
}

bool HomeObject::is_finite_at(const SearchedShapes& shapes, std::uint32_t v) const {
  return is_finite(end_[v]) && (!shapes.moving || start_.size() == 0 || is_finite(start_[v]));
}

/// As `WorldObject::box` of the same elements: faces at rest count only as a whole. Rounding is monotonic, so
/// only the extreme coordinates are rounded.
Aabb HomeObject::box_of(const Cluster& cluster, const SearchedShapes& shapes) const {
  constexpr float greatest = std::numeric_limits<float>::max();
  const auto box_around = [&](const Coordinates& positions, const auto& counts) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3d lowest{infinity, infinity, infinity}, highest = -lowest;
    for (const std::uint32_t v : cluster.vertices) {
      const Vec3d p = positions[v];
      if (!is_finite(p) || !counts(v)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        lowest[axis] = std::min(lowest[axis], p[axis]);
        highest[axis] = std::max(highest[axis], p[axis]);
      }
    }
    Aabb around;
    if (lowest.x > highest.x) return around;
    extend(around, lowest);
    extend(around, highest);
    return around;
  };
  Aabb resting, moving;
  if (shapes.resting || (!shapes.moving && !shapes.near)) {
    const bool all_count = cluster.faces.size() == cluster.elements.size() && cluster.is_finite;
    std::vector<std::uint32_t> counted;  // ascending
    for (std::size_t f = 0; f < cluster.faces.size() && !all_count; ++f) {
      const auto [p, q, r] = cluster.elements[f];
      const std::array corners{cluster.vertices[p], cluster.vertices[q], cluster.vertices[r]};
      if (std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return is_finite(end_[v]); }))
        counted.insert(counted.end(), corners.begin(), corners.end());
    }
    sort_once(counted);
    resting = box_around(end_, [&](std::uint32_t v) {
      return all_count || std::binary_search(counted.begin(), counted.end(), v);
    });
  }
  if (shapes.moving || shapes.near) {
    const bool is_on_path = shapes.moving && start_.size() != 0;
    moving =
        box_around(end_, [&](std::uint32_t v) { return !is_on_path || shapes.near || is_finite(start_[v]); });
    if (is_on_path) extend(moving, box_around(start_, [&](std::uint32_t v) { return is_finite(end_[v]); }));
    for (int axis = 0; axis < 3 && !moving.empty(); ++axis) {
      moving.min[axis] = std::max(moving.min[axis], -greatest);
      moving.max[axis] = std::min(moving.max[axis], greatest);
    }
  }
  extend(resting, moving);
  return resting;
}

void HomeObject::update_boxes(const SearchedShapes& shapes, const Parallel& parallel) {
  parallel.for_ranges(clusters.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t c = begin; c < end; ++c) {
      Cluster& cluster = clusters[c];
      cluster.is_finite = std::all_of(cluster.vertices.begin(), cluster.vertices.end(),
                                      [&](std::uint32_t v) { return is_finite_at(shapes, v); });
      cluster.box = box_of(cluster, shapes);
    }
  });
  box = {};
  for (const Cluster& cluster : clusters) extend(box, cluster.box);
}

void HomeObject::list_non_finite(const SearchedShapes& shapes, std::vector<NonFiniteVertex>& vertices) const {
  std::vector<std::uint32_t> found;
  for (const Cluster& cluster : clusters) {
    for (std::size_t i = 0; i < cluster.vertices.size() && !cluster.is_finite; ++i) {
      const std::uint32_t v = cluster.vertices[i];
      if (!is_finite_at(shapes, v)) found.push_back(v);
    }
  }
  sort_once(found);
  for (const std::uint32_t v : found)
    vertices.push_back({id, user_vertex(v), is_finite(end_[v]) ? start_[v] : end_[v]});
}

bool HomeObject::has_finite_face() const {
  const SearchedShapes on_the_way{.moving = true};
  for (const Cluster& cluster : clusters) {
    for (std::size_t f = 0; f < cluster.faces.size(); ++f) {
      const auto [p, q, r] = cluster.elements[f];
      if (p != q && q != r && r != p && is_finite_at(on_the_way, cluster.vertices[p]) &&
          is_finite_at(on_the_way, cluster.vertices[q]) && is_finite_at(on_the_way, cluster.vertices[r]))
        return true;
    }
  }
  return false;
}

VertexWays HomeObject::ways_of(const Cluster& cluster) const {
  VertexWays ways;
  for (const std::uint32_t v : cluster.vertices) {
    const Vec3d end = end_[v], start = start_.size() != 0 ? start_[v] : end;
    if (!is_finite(start) || !is_finite(end)) continue;
    ways.longest = std::max(ways.longest, scaled_norm(end - start));
    ways.largest_coordinate = std::max(ways.largest_coordinate, largest_magnitude(start));
  }
  return ways;
}

std::vector<std::uint32_t> HomeObject::vertices_of(const Cluster& cluster) const {
  std::vector<std::uint32_t> vertices = cluster.vertices;
  for (std::uint32_t& v : vertices) v = user_vertex(v);
  return vertices;
}

std::array<std::vector<std::uint32_t>, 2> HomeObject::groups_of(const Cluster& cluster) const {
  std::array<std::vector<std::uint32_t>, 2> found;
  for (const std::uint32_t v : cluster.vertices) {
    if (groups_.empty()) break;
    found[0].push_back(groups_[v]);
    found[1].push_back(masks_[v]);
  }
  return found;
}

void HomeObject::write_topology(std::uint32_t cluster, Writer& to) const {
  const Cluster& written = clusters[cluster];
  to.put_all(written.elements);
  to.put_all(written.faces);
  to.put_all(vertices_of(written));
  for (const auto& numbers : groups_of(written)) to.put_all(numbers);
}

void HomeObject::write_positions(std::uint32_t cluster, Writer& to) const {
  const std::vector<std::uint32_t>& vertices = clusters[cluster].vertices;
  to.put(end_.is_double);
  to.put(start_.size() != 0);
  for (const Coordinates* const moment : {&start_, &end_}) {
    if (moment == &start_ && start_.size() == 0) continue;
    to.put<std::uint64_t>(3 * vertices.size());
    if (moment->is_double) {
      write_vertices(moment->doubles, vertices, to);
    } else {
      write_vertices(moment->floats, vertices, to);
    }
  }
}

}  // namespace supple
