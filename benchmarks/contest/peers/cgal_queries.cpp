#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>

#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

class CgalQueries : public QueryContestant {
 public:
  bool answers_kind(QueryTaskKind kind) const override {
    return kind != QueryTaskKind::rays && kind != QueryTaskKind::distance;
  }

  void prepare(const QueryTask& task) override {
    meshes_.resize(task.copies.copies());
    for (Mesh& mesh : meshes_) {
      std::vector<Mesh::Vertex_index> vertices(task.copies.positions(0).size());
      for (auto& vertex : vertices) vertex = mesh.add_vertex({});
      for (const Triangle& t : task.copies.triangles())
        mesh.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
    }
    answers_.resize(task.points.size());
    if (task.kind != QueryTaskKind::penetration) build(task, 0);
  }

  void frame(const QueryTask& task) override {
    if (task.kind == QueryTaskKind::penetration) return find_penetrations(task);
    if (task.kind == QueryTaskKind::closest) {
      for (std::size_t i = 0; i < task.points.size(); ++i)
        answers_[i] = std::sqrt(tree_->squared_distance(point_of(task.points[i])));
      return;
    }
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(*tree_);
    for (std::size_t i = 0; i < task.points.size(); ++i)
      answers_[i] = side(point_of(task.points[i])) == CGAL::ON_BOUNDED_SIDE ? 1 : 0;
  }

 private:
  static Point point_of(const Vec3d& p) { return {p.x, p.y, p.z}; }

  void build(const QueryTask& task, std::size_t copy) {
    Mesh& mesh = meshes_[copy];
    const auto positions = task.copies.positions(copy);
    std::size_t next = 0;
    for (const auto vertex : mesh.vertices()) {
      const Vec3f& p = positions[next++];
      mesh.point(vertex) = {p.x, p.y, p.z};
    }
    tree_ = std::make_unique<Tree>(faces(mesh).first, faces(mesh).second, mesh);
    tree_->build();
    if (task.kind != QueryTaskKind::inside) tree_->accelerate_distance_queries();
  }

  void find_penetrations(const QueryTask& task) {
    answers_.assign(4, 0);
    for (const std::size_t outer : {std::size_t{0}, std::size_t{1}}) {
      const std::size_t inner = 1 - outer;
      build(task, outer);
      const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(*tree_);
      for (const Vec3f& v : task.copies.positions(inner)) {
        const Point p(v.x, v.y, v.z);
        if (side(p) != CGAL::ON_BOUNDED_SIDE) continue;
        answers_[2 * inner] += 1;
        answers_[2 * inner + 1] += std::sqrt(tree_->squared_distance(p));
      }
    }
  }

  std::vector<Mesh> meshes_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace

std::unique_ptr<QueryContestant> make_cgal_queries() {
  return std::make_unique<CgalQueries>();
}

}  // namespace supple::benchmarks
