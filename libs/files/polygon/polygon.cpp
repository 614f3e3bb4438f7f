#include "files/polygon/polygon.hpp"

#include "files/polygon/polygon_cutter.hpp"

namespace supple {

void add_face(TriangleMesh& mesh, std::vector<PolygonFan>& fans, std::span<const std::uint32_t> corners) {
  if (corners.size() == 1) mesh.points.push_back(corners[0]);
  if (corners.size() == 2) mesh.edges.push_back({corners[0], corners[1]});
  if (corners.size() > 3) fans.push_back({mesh.triangles.size(), corners.size()});
  for (std::size_t k = 2; k < corners.size(); ++k) {
    mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }
}

void cut_polygons(TriangleMesh& mesh, std::span<const PolygonFan> fans) {
  PolygonCutter cutter;
  std::vector<std::uint32_t> ids;
  std::vector<Vec3d> corners;
  for (const PolygonFan& fan : fans) {
    const std::span triangles = std::span(mesh.triangles).subspan(fan.first_triangle, fan.corners - 2);
    ids.assign({triangles[0][0], triangles[0][1]});
    for (const Triangle& triangle : triangles) ids.push_back(triangle[2]);
    corners.clear();
    for (const std::uint32_t id : ids) corners.push_back(mesh.positions[id]);

    const PolygonShape shape = cutter.cut(corners, triangles);
    for (Triangle& triangle : triangles) {
      for (std::uint32_t& corner : triangle) corner = ids[corner];
    }
    ++(fan.corners == 4 ? mesh.polygons.quads : mesh.polygons.larger);
    mesh.polygons.concave += shape.concave;
    mesh.polygons.crossing += shape.crosses;
    mesh.polygons.bent += shape.bent;
  }
}

}  // namespace supple
