#include "verify/plain_objects.hpp"

namespace supple {
namespace {

std::vector<Triangle> user_triangles(const WorldObject& object, std::size_t count) {
  const ObjectOctree& octree = object.octree();
  std::vector<Triangle> triangles(count);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) triangles[t] = octree.user_triangle(t);
  return triangles;
}

}  // namespace

PlainObject plain_object(const WorldObject& object) {
  PlainObject plain{
      {}, user_triangles(object, object.face_count()), object.vertex_groups(), object.options.neighbours};
  for (std::uint32_t vertex = 0; vertex < object.octree().vertex_count(); ++vertex)
    plain.positions.push_back(object.placement().position(vertex));
  return plain;
}

PlainMovingObject plain_moving_object(const WorldObject& object) {
  PlainMovingObject plain{{},
                          {},
                          user_triangles(object, object.octree().triangles().size()),
                          object.vertex_groups(),
                          object.face_count()};
  for (std::uint32_t vertex = 0; vertex < object.octree().vertex_count(); ++vertex) {
    plain.start.push_back(object.placement().start_position(vertex));
    plain.end.push_back(object.placement().position(vertex));
  }
  return plain;
}

}  // namespace supple
