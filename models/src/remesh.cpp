#include "remesh.hpp"

#include <algorithm>
#include <cassert>
#include <queue>
#include <tuple>
#include <vector>

namespace supple::models {
namespace {

constexpr std::uint32_t none = ~0u;

Vec3d normal_of(Vec3d a, Vec3d b, Vec3d c) {
  return cross(b - a, c - a);
}

/// Collapses one edge at a time, the relatively shortest first.
class EdgeCollapser {
 public:
  EdgeCollapser(TriangleMesh& mesh, const ImplicitSurface& surface)
      : mesh_(mesh), around_(mesh.positions.size()), stamps_(mesh.positions.size()) {
    for (const Vec3d& p : mesh_.positions) wanted_.push_back(surface.sample(p).edge_length);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t]) around_[v].push_back(t);
    for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v)
      for (const std::uint32_t other : neighbors(v))
        if (v < other) push(v, other);
  }

  void run(std::uint32_t vertex_count) {
    std::size_t left = mesh_.positions.size();
    while (left > vertex_count && !queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      if (next.stamp_a != stamps_[next.a] || next.stamp_b != stamps_[next.b]) continue;
      if (!allowed(next.a, next.b)) continue;
      collapse(next.a, next.b);
      --left;
    }
    assert(left == vertex_count);
    compact();
  }

 private:
  struct Candidate {
    double cost;
    std::uint32_t a, b;
    std::uint32_t stamp_a, stamp_b;
    /// `std::priority_queue` pops the greatest, so the order is reversed: the cheapest and lowest comes
    /// first.
    bool operator<(const Candidate& other) const {
      return std::tie(other.cost, other.a, other.b) < std::tie(cost, a, b);
    }
  };

  std::vector<std::uint32_t> neighbors(std::uint32_t v) const {
    std::vector<std::uint32_t> result;
    result.reserve(around_[v].size());
    // In a closed surface each neighbour follows v in exactly one triangle.
    for (const std::uint32_t t : around_[v]) {
      const Triangle& corners = mesh_.triangles[t];
      result.push_back(corners[0] == v ? corners[1] : corners[1] == v ? corners[2] : corners[0]);
    }
    return result;
  }

  void push(std::uint32_t a, std::uint32_t b) {
    const Vec3d edge = mesh_.positions[b] - mesh_.positions[a];
    const double wanted = (wanted_[a] + wanted_[b]) / 2;
    queue_.push({dot(edge, edge) / (wanted * wanted), a, b, stamps_[a], stamps_[b]});
  }

  bool allowed(std::uint32_t a, std::uint32_t b) const {
    const std::vector<std::uint32_t> of_a = neighbors(a);
    const std::vector<std::uint32_t> of_b = neighbors(b);
    std::vector<std::uint32_t> shared;
    for (const std::uint32_t v : of_a)
      if (std::find(of_b.begin(), of_b.end(), v) != of_b.end()) shared.push_back(v);
    // The link condition of closed surfaces: only then does the collapse keep the topology.
    if (shared.size() != 2) return false;
    for (const std::uint32_t v : shared)
      if (around_[v].size() <= 4) return false;
    constexpr std::size_t max_valence = 9;
    if (of_a.size() + of_b.size() - 4 > max_valence) return false;
    const Vec3d target = lerp(mesh_.positions[a], mesh_.positions[b], 0.5);
    return keeps_facing(a, b, target) && keeps_facing(b, a, target);
  }

  /// True when no triangle of `moved` rotates too far or degenerates if `moved` is moved to `target`. Ignores
  /// triangles that contain `other`.
  bool keeps_facing(std::uint32_t moved, std::uint32_t other, Vec3d target) const {
    for (const std::uint32_t t : around_[moved]) {
      Triangle corners = mesh_.triangles[t];
      if (std::find(corners.begin(), corners.end(), other) != corners.end()) continue;
      std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), moved), corners.end());
      const Vec3d b = mesh_.positions[corners[1]];
      const Vec3d c = mesh_.positions[corners[2]];
      const Vec3d before = normal_of(mesh_.positions[moved], b, c);
      const Vec3d after = normal_of(target, b, c);
      if (dot(before, after) <= 0.3 * norm(before) * norm(after)) return false;
    }
    return true;
  }

  void collapse(std::uint32_t kept, std::uint32_t gone) {
    mesh_.positions[kept] = lerp(mesh_.positions[kept], mesh_.positions[gone], 0.5);
    wanted_[kept] = (wanted_[kept] + wanted_[gone]) / 2;
    for (const std::uint32_t t : around_[gone]) {
      Triangle& triangle = mesh_.triangles[t];
      if (std::find(triangle.begin(), triangle.end(), kept) == triangle.end()) {
        std::replace(triangle.begin(), triangle.end(), gone, kept);
        around_[kept].push_back(t);
        continue;
      }
      for (const std::uint32_t v : triangle)
        if (v != gone) std::erase(around_[v], t);
      triangle = {none, none, none};
    }
    around_[gone].clear();
    ++stamps_[gone];
    ++stamps_[kept];
    for (const std::uint32_t other : neighbors(kept)) push(std::min(kept, other), std::max(kept, other));
  }

  void compact() {
    std::vector<std::uint32_t> new_ids(mesh_.positions.size(), none);
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) {
      if (around_[v].empty()) continue;
      mesh_.positions[count] = mesh_.positions[v];
      new_ids[v] = count++;
    }
    mesh_.positions.resize(count);
    std::erase_if(mesh_.triangles, [](const Triangle& t) { return t[0] == none; });
    for (Triangle& triangle : mesh_.triangles)
      for (std::uint32_t& v : triangle) v = new_ids[v];
  }

  TriangleMesh& mesh_;
  std::vector<double> wanted_;                      // edge length at each vertex
  std::vector<std::vector<std::uint32_t>> around_;  // triangles around each vertex
  std::vector<std::uint32_t> stamps_;               // number of moves of a vertex; older candidates are stale
  std::priority_queue<Candidate> queue_;
};

/// An edge as seen from one of its two triangles.
struct HalfEdge {
  std::uint32_t low, high;  // vertex ids
  std::uint32_t triangle;
  std::uint32_t corner;  // of the triangle: the one opposite to the edge

  bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = mesh.triangles[t][(corner + 1) % 3];
      const std::uint32_t b = mesh.triangles[t][(corner + 2) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, corner});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

double cotangent_at(Vec3d corner, Vec3d a, Vec3d b) {
  const Vec3d u = a - corner;
  const Vec3d v = b - corner;
  return dot(u, v) / norm(cross(u, v));
}

/// Flips each edge whose opposite angles sum to more than 180 degrees and where the surface is nearly flat.
/// Two flips of one pass share no vertex.
void flip_edges(TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  std::vector<std::uint32_t> valence(mesh.positions.size());
  for (const HalfEdge& edge : edges) ++valence[edge.low], ++valence[edge.high];
  for (std::uint32_t& v : valence) v /= 2;
  std::vector<bool> touched(mesh.positions.size());
  const auto& p = mesh.positions;

  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    assert(edges[i].same_edge(edges[i + 1]));
    const Triangle first = mesh.triangles[edges[i].triangle];
    const std::uint32_t corner = edges[i].corner;
    const std::uint32_t c = first[corner];
    const std::uint32_t a = first[(corner + 1) % 3];
    const std::uint32_t b = first[(corner + 2) % 3];
    const std::uint32_t d = mesh.triangles[edges[i + 1].triangle][edges[i + 1].corner];
    if (touched[a] || touched[b] || touched[c] || touched[d]) continue;
    if (valence[a] <= 4 || valence[b] <= 4) continue;
    if (cotangent_at(p[c], p[a], p[b]) + cotangent_at(p[d], p[a], p[b]) >= -1e-9) continue;

    const Vec3d before = unit(normal_of(p[a], p[b], p[c])) + unit(normal_of(p[b], p[a], p[d]));
    const Vec3d after_a = normal_of(p[a], p[d], p[c]);
    const Vec3d after_b = normal_of(p[b], p[c], p[d]);
    constexpr double nearly_flat = 0.8;
    if (dot(unit(after_a), unit(after_b)) < nearly_flat) continue;
    if (dot(before, after_a) <= 0 || dot(before, after_b) <= 0) continue;
    const auto [low, high] = std::minmax(c, d);
    const bool exists = std::any_of(edges.begin(), edges.end(), [&, l = low, h = high](const HalfEdge& e) {
      return e.low == l && e.high == h;
    });
    if (exists) continue;
    mesh.triangles[edges[i].triangle] = {a, d, c};
    mesh.triangles[edges[i + 1].triangle] = {b, c, d};
    touched[a] = touched[b] = touched[c] = touched[d] = true;
  }
}

/// Moves each vertex halfway to the centroid of its triangles, weighted by area in units of the wanted edge
/// length.
void center_vertices(TriangleMesh& mesh, const ImplicitSurface& surface) {
  std::vector<Vec3d> sums(mesh.positions.size());
  std::vector<double> weights(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const auto& p = mesh.positions;
    const Vec3d middle = (p[t[0]] + p[t[1]] + p[t[2]]) * (1.0 / 3);
    const double wanted = surface.sample(middle).edge_length;
    const double weight = norm(normal_of(p[t[0]], p[t[1]], p[t[2]])) / (wanted * wanted);
    for (const std::uint32_t v : t) {
      sums[v] = sums[v] + middle * weight;
      weights[v] += weight;
    }
  }
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    mesh.positions[v] = surface.project(lerp(mesh.positions[v], sums[v] * (1 / weights[v]), 0.5));
}

}  // namespace

void collapse_edges(TriangleMesh& mesh, const ImplicitSurface& surface, std::uint32_t vertex_count) {
  EdgeCollapser(mesh, surface).run(vertex_count);
}

void even_out(TriangleMesh& mesh, const ImplicitSurface& surface, std::uint32_t rounds) {
  for (std::uint32_t round = 0; round < rounds; ++round) {
    flip_edges(mesh);
    center_vertices(mesh, surface);
  }
}

TriangleMesh triangulate_with(const ImplicitSurface& surface, double cell, std::uint32_t vertex_count) {
  TriangleMesh mesh = surface.triangulate(cell);
  collapse_edges(mesh, surface, vertex_count);
  even_out(mesh, surface, 16);
  return mesh;
}

}  // namespace supple::models
