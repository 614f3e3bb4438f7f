#include "answers/moving_objects.hpp"

namespace supple {

void list_moving_objects(const World& world, MovingShape::Part part, std::vector<MovingObject>& objects) {
  objects.clear();
  for (std::uint32_t slot = 0; slot < world.slot_count(); ++slot) {
    objects.emplace_back();
    const WorldObject* const object = world.at(slot);
    if (object == nullptr) continue;
    const bool is_way = part == MovingShape::Part::way;
    const MovingShape& shape = is_way ? object->moving() : object->near();
    MovingObject& listed = objects.back();
    listed.id = world.id_of(slot);
    listed.view = is_way ? object->moving_view() : object->near_view();
    listed.start = &shape.start();
    listed.end = &shape.end();
    listed.triangle_ids = object->octree().triangle_ids();
    listed.vertex_ids = shape.elements().vertex_ids();
    listed.face_count = object->face_count();
    listed.is_point = object->is_point();
    listed.groups = object->vertex_groups();
    listed.margin = object->options.margin;
    listed.min_separation = object->options.min_separation;
  }
}

}  // namespace supple
