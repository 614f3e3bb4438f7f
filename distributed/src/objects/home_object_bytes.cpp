// An object as bytes: its options in messages, and all of it in a checkpoint.

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "objects/home_object.hpp"

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
      Triangle corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = user_vertex(cluster.vertices[cluster.elements[e][i]]);
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

SavedObject read_object(std::span<const std::span<const std::byte>> parts) {
  SavedObject object;
  std::vector<SavedFace> faces;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> points;
  std::vector<SavedVertex> vertices;
  for (const std::span<const std::byte> part : parts) {
    Reader from(part);
    object.options = read_options(from);
    object.options.is_static = from.get<bool>();
    object.is_part = from.get<bool>();
    object.has_motion = from.get<bool>() || object.has_motion;
    object.is_double = from.get<bool>() || object.is_double;
    from.append_all(faces);
    from.append_all(edges);
    from.append_all(points);
    from.append_all(vertices);
  }
  std::sort(faces.begin(), faces.end());
  std::sort(vertices.begin(), vertices.end());
  const auto end = std::unique(vertices.begin(), vertices.end(),
                               [](const auto& p, const auto& q) { return p.number == q.number; });
  vertices.erase(end, vertices.end());
  const auto local = [&](std::uint32_t number) {
    const auto found = std::lower_bound(vertices.begin(), vertices.end(), SavedVertex{number});
    if (found == vertices.end() || found->number != number)
      fail("vertex " + std::to_string(number) + " of " + object.options.name + " is missing");
    return static_cast<std::uint32_t>(found - vertices.begin());
  };
  for (const SavedFace& face : faces) {
    object.faces.push_back(face.number);
    object.triangles.push_back({local(face.corners[0]), local(face.corners[1]), local(face.corners[2])});
  }
  for (const auto& edge : edges) object.options.edges.push_back({local(edge[0]), local(edge[1])});
  for (const std::uint32_t point : points) object.options.points.push_back(local(point));
  const bool has_groups =
      std::any_of(vertices.begin(), vertices.end(), [](const auto& v) { return v.is_grouped != 0; });
  for (const SavedVertex& vertex : vertices) {
    object.vertices.push_back(vertex.number);
    if (has_groups) {
      object.groups.push_back(vertex.group);
      object.masks.push_back(vertex.mask);
    }
    object.start.insert(object.start.end(), vertex.start.begin(), vertex.start.end());
    object.end.insert(object.end.end(), vertex.end.begin(), vertex.end.end());
  }
  return object;
}

HomeObject HomeObject::of(ObjectId id, const SavedObject& saved, std::uint32_t cluster_triangles,
                          std::uint32_t addition) {
  const ObjectPart part{saved.vertices, saved.faces};
  HomeObject object(id, PositionsView(saved.end), saved.triangles, saved.is_part ? &part : nullptr,
                    saved.options, cluster_triangles, addition);
  object.set_vertex_groups(saved.groups, saved.masks);
  saved.visit_positions([&](const PositionsView& start, const PositionsView& end) {
    object.end_.assign(end);
    if (saved.has_motion) object.start_.assign(start);
  });
  return object;
}

}  // namespace supple
