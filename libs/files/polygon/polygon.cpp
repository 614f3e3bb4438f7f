#include "files/polygon/polygon.hpp"

#include <algorithm>
#include <cassert>

#include "files/polygon/outline.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Whether the fan of the first corner covers the inside once: all triangles turn left, and all together turn
/// around the first corner at most once.
bool fan_stays_inside(const OutlineView& view) {
  // Corners at the place of the first one that follow or precede it change nothing.
  std::uint32_t first = 1, last = static_cast<std::uint32_t>(view.size()) - 1;
  while (first < last && view.same_place(0, first)) ++first;
  while (first < last && view.same_place(0, last)) --last;
  int half_turns = 0;
  for (std::uint32_t k = first; k < last; ++k) {
    if (view.side(std::uint32_t{0}, k, k + 1) < 0 || view.same_place(0, k)) return false;
    if (view.before(0, k) != view.before(0, k + 1)) ++half_turns;
  }
  return half_turns < 2 || (half_turns == 2 && view.side(std::uint32_t{0}, first, last) <= 0);
}

bool turns_right_somewhere(const OutlineView& view) {
  const auto count = static_cast<std::uint32_t>(view.size());
  for (std::uint32_t k = 0; k < count; ++k) {
    if (view.side(k, (k + 1) % count, (k + 2) % count) < 0) return true;
  }
  return false;
}

}  // namespace

PolygonShape cut_polygon(std::span<const Vec3d> corners, std::span<Triangle> triangles) {
  assert(corners.size() >= 3 && triangles.size() == corners.size() - 2);
  for (std::uint32_t k = 0; k < triangles.size(); ++k) triangles[k] = {0, k + 1, k + 2};
  PolygonShape shape;
  if (corners.size() == 3 || !std::all_of(corners.begin(), corners.end(), is_finite)) return shape;
  const OutlineView view(corners);
  if (!view) return shape;
  shape.bent = is_bent(corners);
  if (!fan_stays_inside(view)) {
    const OutlineWinding winding = find_winding(view);
    shape.crosses = winding.crosses;
    if (!clip_ears(view, winding, triangles)) shape.crosses = true;
  }
  shape.concave = !shape.crosses && turns_right_somewhere(view);
  return shape;
}

void add_face(TriangleMesh& mesh, std::vector<PolygonFan>& fans, std::span<const std::uint32_t> corners) {
  if (corners.size() == 1) mesh.points.push_back(corners[0]);
  if (corners.size() == 2) mesh.edges.push_back({corners[0], corners[1]});
  if (corners.size() > 3) fans.push_back({mesh.triangles.size(), corners.size()});
  for (std::size_t k = 2; k < corners.size(); ++k) {
    mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }
}

void cut_polygons(TriangleMesh& mesh, std::span<const PolygonFan> fans) {
  std::vector<std::uint32_t> ids;
  std::vector<Vec3d> corners;
  for (const PolygonFan& fan : fans) {
    const std::span triangles = std::span(mesh.triangles).subspan(fan.first_triangle, fan.corners - 2);
    ids.assign({triangles[0][0], triangles[0][1]});
    for (const Triangle& triangle : triangles) ids.push_back(triangle[2]);
    corners.clear();
    for (const std::uint32_t id : ids) corners.push_back(mesh.positions[id]);

    const PolygonShape shape = cut_polygon(corners, triangles);
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
