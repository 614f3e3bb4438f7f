// Regions of the scene and cells of octrees in a frame.

#include <algorithm>
#include <tuple>
#include <utility>

#include "messages/frame_message.hpp"
#include "supple/inspection.hpp"

namespace supple::viewer {

void FramePacker::add_octree(const FrameView& frame, std::uint32_t object) {
  const ObjectId id = frame.source.id(object);
  const SceneInspector inspector(frame.source.scene());
  octree_levels_.push_back(inspector.octree_depth(id));
  add_cells(frame, "octree", {Tag::octree_boxes, Tag::octree_spheres, Tag::octree_edges}, object,
            inspector.cells(id, frame.layers.octree_level));
}

/// Adds the nodes of each object that collide, each once.
void FramePacker::add_colliding_nodes(const FrameView& frame, const CollidingNodes& wanted) {
  const SceneInspector inspector(frame.source.scene());
  std::vector<std::vector<OctreeCell>> cells(frame.show.objects.size());
  const auto add = [&](ObjectId a, ObjectId b) {
    const NodePairList list = inspector.node_pairs(a, b);
    std::vector<std::uint8_t> is_wanted_a(list.nodes_a.size(), 0), is_wanted_b(list.nodes_b.size(), 0);
    for (std::uint32_t level = 0; level < list.level_count(); ++level) {
      if (wanted.level >= 0 && wanted.level != level) continue;
      for (const NodePairList::Pair& pair : list.pairs_of(level)) {
        if (wanted.level == CollidingNodes::leaves && !list.is_leaf_pair(pair)) continue;
        is_wanted_a[pair.a] = is_wanted_b[pair.b] = 1;
      }
    }
    for (std::size_t i = 0; i < is_wanted_a.size(); ++i) {
      if (is_wanted_a[i] != 0) cells[a.index].push_back(list.nodes_a[i]);
    }
    for (std::size_t i = 0; i < is_wanted_b.size(); ++i) {
      if (is_wanted_b[i] != 0) cells[b.index].push_back(list.nodes_b[i]);
    }
  };
  if (wanted.objects) {
    add(frame.source.id((*wanted.objects)[0]), frame.source.id((*wanted.objects)[1]));
  } else {
    for (const ObjectPair& pair : frame.source.scene().result().object_pairs) add(pair.a, pair.b);
  }
  for (std::uint32_t object = 0; object < cells.size(); ++object) {
    const auto key = [](const OctreeCell& cell) {
      const Vec3f& at = cell.box.min;
      return std::tuple(cell.level, cell.number, at.x, at.y, at.z);
    };
    std::vector<OctreeCell>& list = cells[object];
    std::sort(list.begin(), list.end(), [&](const auto& p, const auto& q) { return key(p) < key(q); });
    const auto same = [&](const auto& p, const auto& q) { return key(p) == key(q); };
    list.erase(std::unique(list.begin(), list.end(), same), list.end());
    if (!list.empty())
      add_cells(frame, "colliding_nodes",
                {Tag::colliding_boxes, Tag::colliding_spheres, Tag::colliding_edges}, object,
                std::move(list));
  }
}

/// Adds the spheres, oriented boxes, k-DOPs or boxes of the cells. Cells without a finite triangle have none.
void FramePacker::add_cells(const FrameView& frame, const char* layer, CellTags tags, std::uint32_t object,
                            std::vector<OctreeCell> cells) {
  std::erase_if(cells, [](const OctreeCell& cell) { return cell.box.empty() && cell.sphere.empty(); });
  if (!cells.empty() && !cells.front().slabs.empty())
    return add_edges(frame, layer, tags.edges, object, cells);
  const bool has_spheres = !cells.empty() && !cells.front().sphere.empty();
  const std::size_t count = limited(layer, cells.size());
  const auto rows = message_->add<Row>(has_spheres ? tags.spheres : tags.boxes, object, count);
  for (std::size_t i = 0; i < count; ++i) {
    const OctreeCell& cell = cells[i];
    const float level = static_cast<float>(cell.level);
    const float triangles = cell.is_leaf ? static_cast<float>(cell.triangle_count) : -1;
    rows[i] = has_spheres
                  ? row_of(frame.center(cell.sphere.center), cell.sphere.radius, {level, triangles, 0}, 0)
                  : row_of(frame.center(cell.box.min), level, frame.center(cell.box.max), triangles);
  }
}

/// Adds the edges of oriented boxes or k-DOPs.
void FramePacker::add_edges(const FrameView& frame, const char* layer, Tag tag, std::uint32_t object,
                            std::span<const OctreeCell> cells) {
  edges_.clear();
  for (const OctreeCell& cell : cells) {
    const float level = static_cast<float>(cell.level);
    const float triangles = cell.is_leaf ? static_cast<float>(cell.triangle_count) : -1;
    for (const auto& [from, to] : edges_of(cell.slabs))
      edges_.push_back(row_of(frame.center(from), level, frame.center(to), triangles));
  }
  const std::size_t count = limited(layer, edges_.size());
  std::copy_n(edges_.begin(), count, message_->add<Row>(tag, object, count).begin());
}

void FramePacker::add_scene_regions(const FrameView& frame) {
  const std::vector<SceneRegion> regions = SceneInspector(frame.source.scene()).regions();
  const auto rows = message_->add<Row>(Tag::scene_regions, limited("scene_regions", regions.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SceneRegion& region = regions[i];
    rows[i] =
        row_of(frame.center(region.box.min), static_cast<float>(region.level), frame.center(region.box.max),
               region.is_leaf ? static_cast<float>(region.object_count) : -1);
  }
}

}  // namespace supple::viewer
