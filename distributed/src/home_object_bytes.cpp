// An object as bytes: its options in messages, and all of it in a checkpoint.

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "home_object.hpp"

namespace supple {
namespace {

/// A face with the user's numbers.
struct SavedFace {
  std::uint32_t number = 0;
  Triangle corners{};

  constexpr auto operator<=>(const SavedFace&) const = default;
};

struct SavedVertex {
  std::uint32_t number = 0, is_grouped = 0, group = ~std::uint32_t{0}, mask = group;
  std::array<double, 3> start{}, end{};

  bool operator<(const SavedVertex& other) const { return number < other.number; }
};

}  // namespace

void write_options(const ObjectOptions& options, Writer& to) {
  to.put_all(options.name);
  to.put(options.self_collision);
  to.put(options.neighbours);
  to.put(options.margin);
  to.put(options.min_separation);
  to.put(options.solid);
  to.put(options.group);
  to.put(options.mask);
}

ObjectOptions read_options(Reader& from) {
  const std::vector<char> name = from.get_all<char>();
  ObjectOptions options;
  options.name.assign(name.begin(), name.end());
  options.self_collision = from.get<bool>();
  options.neighbours = from.get<Neighbours>();
  options.margin = from.get<double>();
  options.min_separation = from.get<double>();
  options.solid = from.get<bool>();
  options.group = from.get<std::uint32_t>();
  options.mask = from.get<std::uint32_t>();
  return options;
}

void HomeObject::write(Writer& to) const {
  std::vector<SavedFace> faces;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> points;
  for (const Cluster& cluster : clusters) {
    for (std::size_t e = 0; e < cluster.elements.size(); ++e) {
      Triangle corners = cluster.elements[e];
      for (std::uint32_t& corner : corners) corner = user_vertex(cluster.vertices[corner]);
      if (e < cluster.faces.size()) {
        faces.push_back({cluster.faces[e], corners});
      } else if (corners[0] == corners[1]) {
        points.push_back(corners[0]);
      } else {
        edges.push_back({corners[0], corners[1]});
      }
    }
  }
  std::vector<SavedVertex> vertices;
  for (std::uint32_t v = 0; v < vertex_count_; ++v) {
    const Vec3d end = end_[v], start = has_motion() ? start_[v] : end;
    SavedVertex vertex{
        .number = user_vertex(v), .start = {start.x, start.y, start.z}, .end = {end.x, end.y, end.z}};
    if (has_vertex_groups()) {
      vertex.is_grouped = 1;
      vertex.group = groups_[v];
      vertex.mask = masks_[v];
    }
    vertices.push_back(vertex);
  }
  write_options(options, to);
  to.put(options.is_static);
  to.put(is_part_);
  to.put(has_motion());
  to.put(end_.is_double);
  to.put_all(faces);
  to.put_all(edges);
  to.put_all(points);
  to.put_all(vertices);
}

HomeObject HomeObject::read(ObjectId id, std::span<const std::span<const std::byte>> parts,
                            std::uint32_t cluster_triangles, std::uint32_t addition) {
  ObjectOptions options;
  bool is_part = false, has_motion = false, is_double = false;
  std::vector<SavedFace> faces;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<SavedVertex> vertices;
  for (const std::span<const std::byte> part : parts) {
    Reader from(part);
    std::vector<std::uint32_t> points = options.points;
    ObjectOptions of_part = read_options(from);
    of_part.is_static = from.get<bool>();
    is_part = from.get<bool>();
    has_motion = from.get<bool>() || has_motion;
    is_double = from.get<bool>() || is_double;
    from.append_all(faces);
    from.append_all(edges);
    from.append_all(points);
    from.append_all(vertices);
    options = of_part;
    options.points = std::move(points);
  }
  std::sort(faces.begin(), faces.end());
  std::sort(vertices.begin(), vertices.end());
  const auto end = std::unique(vertices.begin(), vertices.end(),
                               [](const auto& p, const auto& q) { return p.number == q.number; });
  vertices.erase(end, vertices.end());
  const auto local = [&](std::uint32_t number) {
    const auto found = std::lower_bound(vertices.begin(), vertices.end(), SavedVertex{number});
    if (found == vertices.end() || found->number != number)
      fail("vertex " + std::to_string(number) + " of " + options.name + " is missing");
    return static_cast<std::uint32_t>(found - vertices.begin());
  };
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> face_ids, vertex_ids, groups, masks;
  for (const SavedFace& face : faces) {
    face_ids.push_back(face.number);
    triangles.push_back({local(face.corners[0]), local(face.corners[1]), local(face.corners[2])});
  }
  for (const auto& edge : edges) options.edges.push_back({local(edge[0]), local(edge[1])});
  for (std::uint32_t& point : options.points) point = local(point);
  std::vector<double> start, positions;
  for (const SavedVertex& vertex : vertices) {
    vertex_ids.push_back(vertex.number);
    groups.push_back(vertex.group);
    masks.push_back(vertex.mask);
    start.insert(start.end(), vertex.start.begin(), vertex.start.end());
    positions.insert(positions.end(), vertex.end.begin(), vertex.end.end());
  }
  const ObjectPart part{vertex_ids, face_ids};
  const auto with = [&](const PositionsView& from, const PositionsView& now) {
    HomeObject object(id, now, triangles, is_part ? &part : nullptr, options, cluster_triangles, addition);
    if (has_motion) object.start_.assign(from);
    if (std::any_of(vertices.begin(), vertices.end(), [](const auto& v) { return v.is_grouped != 0; }))
      object.set_vertex_groups(groups, masks);
    return object;
  };
  if (is_double) return with(PositionsView(start), PositionsView(positions));
  const std::vector<float> float_start(start.begin(), start.end()),
      float_positions(positions.begin(), positions.end());
  return with(PositionsView(float_start), PositionsView(float_positions));
}

}  // namespace supple
