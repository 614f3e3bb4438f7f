#include "motion/network/mesh_pieces.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "supple/scene.hpp"

namespace supple {
namespace {

struct Piece {
  std::vector<std::uint32_t> vertices;
  std::vector<Triangle> triangles;
};

/// The pieces with triangles, the largest first; among equals, the one with the lowest vertex.
std::vector<Piece> pieces_by_size(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> lowest = lowest_of_piece(mesh);
  std::vector<Piece> pieces(lowest.size());
  for (const Triangle& t : mesh.triangles) {
    if (!spans_nothing(t)) pieces[lowest[t[0]]].triangles.push_back(t);
  }
  for (std::uint32_t v = 0; v < lowest.size(); ++v) pieces[lowest[v]].vertices.push_back(v);
  std::erase_if(pieces, [](const Piece& piece) { return piece.triangles.empty(); });
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    if (a.vertices.size() != b.vertices.size()) return a.vertices.size() > b.vertices.size();
    return a.vertices.front() < b.vertices.front();
  });
  return pieces;
}

/// The piece as a mesh of its own.
TriangleMesh alone(const Piece& piece, const TriangleMesh& mesh) {
  TriangleMesh own;
  for (const std::uint32_t v : piece.vertices) own.positions.push_back(mesh.positions[v]);
  for (Triangle t : piece.triangles) {
    for (std::uint32_t& v : t) {
      const auto place = std::lower_bound(piece.vertices.begin(), piece.vertices.end(), v);
      v = static_cast<std::uint32_t>(place - piece.vertices.begin());
    }
    own.triangles.push_back(t);
  }
  return own;
}

}  // namespace

std::vector<std::uint32_t> lowest_of_piece(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    if (spans_nothing(t)) continue;
    for (const std::uint32_t other : {t[1], t[2]}) {
      const std::uint32_t a = root(t[0]), b = root(other);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

std::vector<std::array<std::uint32_t, 2>> connections_of_pieces(const TriangleMesh& mesh) {
  constexpr std::size_t most_vertices = 16;
  const std::vector<Piece> pieces = pieces_by_size(mesh);
  std::vector<std::array<std::uint32_t, 2>> pairs;
  SceneOptions options;
  options.threads = 1;
  Scene larger(options);  // object i is pieces[i]
  for (const Piece& piece : pieces) {
    const TriangleMesh own = alone(piece, mesh);
    std::vector<std::optional<ClosestPoint>> closest(own.positions.size());
    larger.closest(own.positions, closest);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < closest.size(); ++i) {
      if (closest[i]) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      return std::pair(closest[i]->distance, i) < std::pair(closest[j]->distance, j);
    });
    if (order.size() > most_vertices) order.resize(most_vertices);
    for (const std::size_t i : order) {
      for (const std::uint32_t corner : pieces[closest[i]->object.index].triangles[closest[i]->triangle])
        pairs.push_back({std::min(piece.vertices[i], corner), std::max(piece.vertices[i], corner)});
    }
    larger.add(own);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace supple
