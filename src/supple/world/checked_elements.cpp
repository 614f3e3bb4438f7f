#include "world/checked_elements.hpp"

#include <algorithm>
#include <array>

#include "core/error.hpp"

namespace supple {

std::vector<Triangle> checked_triangles(const std::string& name, std::size_t vertex_count,
                                        const TrianglesView& view, const Parallel& parallel) {
  constexpr std::size_t most = 0xffffffff, grain = 8192;
  if (vertex_count >= most || view.size() >= most) fail(name + ": more than 2^32 - 2 vertices or triangles");
  const auto is_vertex = [&](std::int64_t id) {
    return id >= 0 && id < static_cast<std::int64_t>(vertex_count);
  };
  std::vector<Triangle> triangles(view.size());
  const bool are_all = parallel.all_of_ranges(view.size(), grain, [&](std::size_t begin, std::size_t end) {
    bool are_vertices = true;
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<std::int64_t, 3> ids = view[t];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        are_vertices = are_vertices && is_vertex(ids[corner]);
        triangles[t][corner] = static_cast<std::uint32_t>(ids[corner]);
      }
    }
    return are_vertices;
  });
  for (std::size_t t = 0; !are_all && t < triangles.size(); ++t) {
    for (const std::int64_t id : view[t]) {
      if (is_vertex(id)) continue;
      fail(name + ": triangle " + std::to_string(t) + " uses vertex " + std::to_string(id) +
           ", but there are " + std::to_string(vertex_count) + " vertices, numbered from 0");
    }
  }
  return triangles;
}

std::vector<Triangle> checked_extra_elements(std::size_t vertex_count, const ObjectOptions& options) {
  const auto check_vertex = [&](std::uint32_t vertex, const char* what, std::size_t i) {
    if (vertex < vertex_count) return;
    fail(options.name + ": " + what + " " + std::to_string(i) + " uses vertex " + std::to_string(vertex) +
         ", but there are " + std::to_string(vertex_count) + " vertices, numbered from 0");
  };
  std::vector<Triangle> elements;
  for (std::size_t i = 0; i < options.edges.size(); ++i) {
    const auto [v, w] = std::minmax(options.edges[i][0], options.edges[i][1]);
    check_vertex(w, "edge", i);
    if (v == w)
      fail(options.name + ": both ends of edge " + std::to_string(i) + " are vertex " + std::to_string(v) +
           "; list it in points");
    elements.push_back({v, w, w});
  }
  for (std::size_t i = 0; i < options.points.size(); ++i) {
    const std::uint32_t v = options.points[i];
    check_vertex(v, "point", i);
    elements.push_back({v, v, v});
  }
  return elements;
}

}  // namespace supple
