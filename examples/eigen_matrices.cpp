// Positions and triangles in Eigen matrices, row-major or column-major, as libigl and many solvers keep them.
#include <Eigen/Core>
#include <cstdio>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  const supple::TriangleMesh sphere = supple::make_icosphere(8);
  const auto vertices = static_cast<Eigen::Index>(sphere.positions.size());
  const auto triangles = static_cast<Eigen::Index>(sphere.triangles.size());
  Eigen::MatrixXd V(vertices, 3);
  for (Eigen::Index i = 0; i < vertices; ++i) {
    const supple::Vec3d& p = sphere.positions[static_cast<std::size_t>(i)];
    V.row(i) << p.x, p.y, p.z;
  }
  Eigen::MatrixXi F(triangles, 3);
  for (Eigen::Index t = 0; t < triangles; ++t) {
    for (int corner = 0; corner < 3; ++corner)
      F(t, corner) =
          static_cast<int>(sphere.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(corner)]);
  }

  supple::Scene scene;
  scene.add(V, F, {.name = "rows", .is_static = true});
  // Points in columns of a column-major matrix lie next to each other, so the scene can read them in place.
  Eigen::Matrix3Xd moving = V.transpose();
  const supple::ObjectId columns = scene.add(moving, F, {.name = "columns"});
  for (int frame = 0; frame < 5; ++frame) {
    moving = V.transpose().colwise() + Eigen::Vector3d(2.2 - 0.1 * frame, 0.1, 0.05);
    scene.share_positions(columns, moving);
    std::printf("frame %d: %zu contacts\n", frame, scene.detect().contacts.size());
  }
}
