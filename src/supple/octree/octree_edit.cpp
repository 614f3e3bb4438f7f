// Removes triangles from an octree and adds some: builds the subtrees around them again, and joins them with
// the rest.

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/vector.hpp"
#include "octree/build/balanced_build.hpp"
#include "octree/object_octree.hpp"

namespace supple {

/// A subtree that is built again.
struct ObjectOctree::EditedSubtree {
  std::uint32_t node = 0;                 ///< its root
  std::uint32_t begin = 0, end = 0;       ///< its triangles in the order of the octree before
  Triangles listed;                       ///< after the edit
  std::vector<std::uint32_t> vertices{};  ///< of these triangles
  std::optional<ObjectOctree> built{};    ///< of these vertices, numbered from 0

  /// `numbers` has `no_place` for each vertex of the object, also afterwards.
  void build(const PositionsView& positions, const ObjectOctree& whole, std::vector<std::uint32_t>& numbers) {
    std::vector<Triangle> triangles = listed.triangles;
    for (Triangle& triangle : triangles) {
      for (std::uint32_t& v : triangle) {
        if (numbers[v] == no_place) {
          numbers[v] = static_cast<std::uint32_t>(vertices.size());
          vertices.push_back(v);
        }
        v = numbers[v];
      }
    }
    for (const std::uint32_t v : vertices) numbers[v] = no_place;
    std::vector<Vec3d> places;
    places.reserve(vertices.size());
    for (const std::uint32_t v : vertices) places.push_back(positions[v]);
    built.emplace(places, triangles, whole.options_, whole.bounding_volume_, whole.sphere_fit_);
  }
};

ObjectOctree::Triangles ObjectOctree::listed_triangles(std::span<const std::uint32_t> without) const {
  Triangles listed;
  listed.triangles.reserve(triangles_.size());
  listed.ids.reserve(triangles_.size());
  auto next = without.begin();
  for (std::uint32_t id = 0; id < triangle_order_.size(); ++id) {
    if (next != without.end() && *next == id)
      ++next;
    else if (has_triangle(id))
      listed.push(user_triangle(id), id);
  }
  return listed;
}

/// The lowest node that contains a triangle, by its place.
std::uint32_t ObjectOctree::lowest_node_with(std::uint32_t triangle) const {
  std::uint32_t n = 0;
  while (true) {
    const int child = nodes_[n].child_with(triangle);
    if (!nodes_[n].is_inner(child)) return n;
    n = nodes_[n].child_node(child);
  }
}

/// The node above the leaf that is reached by the child whose box is nearest, of equally near ones the
/// smallest.
std::uint32_t ObjectOctree::lowest_node_near(const Vec3d& point) const {
  std::uint32_t n = 0;
  while (true) {
    int nearest = 0;
    std::pair<double, double> least;  // the gap, then the surface
    for (int child = 0; child < nodes_[n].child_count; ++child) {
      const Aabb box = child_box(boxes_[n], child);
      const std::pair candidate(
          squared_gap(QueryBox{{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}},
                      QueryBox{point, point}),
          half_surface(box));
      if (child > 0 && !(candidate < least)) continue;
      nearest = child;
      least = candidate;
    }
    if (!nodes_[n].is_inner(nearest)) return n;
    n = nodes_[n].child_node(nearest);
  }
}

/// Chooses subtrees in which the number of triangles after the edit is more than that of a leaf, and which
/// are as large as a few times the edit, because larger subtrees are better ones.
std::vector<ObjectOctree::EditedSubtree> ObjectOctree::subtrees_to_edit(
    std::span<const std::uint32_t> removed, std::span<const Triangle> added,
    const PositionsView& positions) const {
  constexpr std::uint32_t times_the_edit = 4;
  std::vector<std::uint32_t> places, nodes;  // of removed triangles; of these, then of added ones
  for (const std::uint32_t id : removed) places.push_back(triangle_order_[id]);
  std::sort(places.begin(), places.end());
  for (const std::uint32_t place : places) nodes.push_back(lowest_node_with(place));
  for (const Triangle& t : added)
    nodes.push_back(lowest_node_near((1.0 / 3) * (positions[t[0]] + positions[t[1]] + positions[t[2]])));
  std::vector<std::uint32_t> sizes(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) sizes[n] = nodes_[n].size();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::uint32_t change = i < places.size() ? ~std::uint32_t{0} : 1;  // modulo 2^32
    for (std::uint32_t n = nodes[i];; n = nodes_[n].parent) {
      sizes[n] += change;
      if (n == 0) break;
    }
  }
  const auto most =
      std::max(options_.leaf_size * node_width, times_the_edit * static_cast<std::uint32_t>(nodes.size()));
  std::vector<std::uint8_t> is_chosen(nodes_.size(), 0);
  for (std::uint32_t n : nodes) {
    while (n != 0 && (sizes[n] <= options_.leaf_size || sizes[nodes_[n].parent] <= most))
      n = nodes_[n].parent;
    is_chosen[n] = 1;
  }
  std::vector<EditedSubtree> subtrees;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {  // parents come first
    if (n != 0 && is_chosen[nodes_[n].parent] != 0) is_chosen[n] = 2;
    if (is_chosen[n] != 1) continue;
    const auto end = nodes_[n].first_triangle[node_width];
    subtrees.push_back({.node = n, .begin = nodes_[n].first_triangle[0], .end = end, .listed = {}});
  }
  std::ranges::sort(subtrees, {}, &EditedSubtree::begin);
  auto next_removed = places.begin();
  for (EditedSubtree& subtree : subtrees) {
    for (std::uint32_t t = subtree.begin; t < subtree.end; ++t) {
      if (next_removed != places.end() && *next_removed == t) {
        ++next_removed;
        continue;
      }
      subtree.listed.push(triangles_[t], triangle_ids_[t]);
    }
  }
  for (std::size_t i = 0; i < added.size(); ++i) {
    const std::uint32_t place = nodes_[nodes[places.size() + i]].first_triangle[0];
    const auto subtree = std::ranges::upper_bound(subtrees, place, {}, &EditedSubtree::begin) - 1;
    subtree->listed.push(added[i], id_count() + i);
  }
  return subtrees;
}

void ObjectOctree::edit(std::span<const std::uint32_t> removed, std::span<const Triangle> added,
                        const PositionsView& positions, bool is_local, const Parallel& parallel) {
  constexpr std::uint32_t levels_of_subtree = 4;
  const bool is_deep = level_begin_.size() + levels_of_subtree > options_.max_level;
  if (!is_local || nodes_.empty() || is_deep || 4 * (removed.size() + added.size()) > triangles_.size()) {
    Triangles listed = listed_triangles(removed);
    for (std::size_t i = 0; i < added.size(); ++i) listed.push(added[i], id_count() + i);
    *this = built_like_this(positions, listed, id_count() + added.size(), parallel);
    return;
  }
  std::vector<EditedSubtree> subtrees = subtrees_to_edit(removed, added, positions);
  std::vector<std::uint32_t> numbers(positions.size(), no_place);
  for (EditedSubtree& subtree : subtrees) subtree.build(positions, *this, numbers);
  triangle_order_.reserve(id_count() + added.size());
  splice(subtrees, id_count() + added.size());
  vertex_count_ = positions.size();
  for (const std::uint32_t id : removed) triangle_order_[id] = no_place;
}

/// Copies the nodes level by level and the triangles in order, with the new subtrees in place of theirs.
void ObjectOctree::splice(std::span<const EditedSubtree> subtrees, std::size_t id_count) {
  constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Source {
    std::uint32_t subtree, node;
  };
  std::vector<std::uint32_t> subtree_at(nodes_.size(), none), first_places;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> ids;
  // The blocks between subtrees, and the subtrees.
  const auto for_blocks = [&](const auto& keep, const auto& replace) {
    std::uint32_t begin = 0;
    for (const EditedSubtree& subtree : subtrees) {
      keep(begin, subtree.begin);
      replace(subtree);
      begin = subtree.end;
    }
    keep(begin, static_cast<std::uint32_t>(triangles_.size()));
  };
  std::size_t count = triangles_.size();
  for (const EditedSubtree& subtree : subtrees)
    count += subtree.listed.triangles.size() - (subtree.end - subtree.begin);
  triangles.reserve(count);
  ids.reserve(count);
  for_blocks(
      [&](std::uint32_t begin, std::uint32_t end) {
        triangles.insert(triangles.end(), triangles_.begin() + begin, triangles_.begin() + end);
        ids.insert(ids.end(), triangle_ids_.begin() + begin, triangle_ids_.begin() + end);
      },
      [&](const EditedSubtree& subtree) {
        subtree_at[subtree.node] = static_cast<std::uint32_t>(first_places.size());
        first_places.push_back(static_cast<std::uint32_t>(triangles.size()));
        for (const std::uint32_t t : subtree.built->triangle_ids_) {
          triangles.push_back(subtree.listed.triangles[t]);
          ids.push_back(subtree.listed.ids[t]);
        }
      });
  std::vector<std::uint8_t> corners(3 * count + corners_ahead, 0);
  for (std::size_t corner = 0; corner < 3; ++corner) {
    auto to = corners.begin() + static_cast<std::ptrdiff_t>(corner * count);
    const auto copy = [&](const ObjectOctree& octree, std::size_t begin, std::size_t end) {
      const LeafVertexArrays from = octree.leaf_vertices();
      to = std::copy(from.corners + corner * from.stride + begin, from.corners + corner * from.stride + end,
                     to);
    };
    for_blocks(
        [&](std::uint32_t begin, std::uint32_t end) { copy(*this, begin, end); },
        [&](const EditedSubtree& subtree) { copy(*subtree.built, 0, subtree.listed.triangles.size()); });
  }
  const auto place_after = [&](std::uint32_t place) {
    const auto next = std::ranges::upper_bound(subtrees, place, {}, &EditedSubtree::end);
    if (next == subtrees.begin()) return place;
    const EditedSubtree& last = next[-1];
    const std::uint32_t end = first_places[static_cast<std::size_t>(next - subtrees.begin()) - 1] +
                              static_cast<std::uint32_t>(last.listed.triangles.size());
    return end + (place - last.end);
  };
  std::vector<OctreeNode> nodes;
  std::vector<Source> sources;
  std::vector<std::uint32_t> level_begin, first_leaf_vertex, leaf_vertices;
  const auto push = [&](Source source, std::uint32_t parent, int index, int level) {
    if (source.subtree == none && subtree_at[source.node] != none) source = {subtree_at[source.node], 0};
    const ObjectOctree& octree = source.subtree == none ? *this : *subtrees[source.subtree].built;
    if (octree.nodes_.empty()) return;
    nodes.push_back(octree.nodes_[source.node]);
    nodes.back().parent = parent;
    nodes.back().index_in_parent = static_cast<std::uint8_t>(index);
    nodes.back().level = static_cast<std::uint8_t>(level);
    sources.push_back(source);
  };
  push({none, 0}, 0, 0, 0);
  leaf_vertices.reserve(leaf_vertices_.size());
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    const auto [subtree, old] = sources[n];
    const ObjectOctree& octree = subtree == none ? *this : *subtrees[subtree].built;
    OctreeNode node = nodes[n];
    if (node.level == level_begin.size()) level_begin.push_back(n);
    node.first_child = static_cast<std::uint32_t>(nodes.size());
    for (std::uint32_t& place : node.first_triangle)
      place = subtree == none ? place_after(place) : first_places[subtree] + place;
    nodes[n] = node;
    for (int child = 0; child < node_width; ++child) {
      if (child < node.child_count && node.is_inner(child))
        push({subtree, octree.nodes_[old].child_node(child)}, n, child, node.level + 1);
      const std::uint32_t* const list = &octree.first_leaf_vertex_[std::size_t{old} * node_width + child];
      first_leaf_vertex.push_back(static_cast<std::uint32_t>(leaf_vertices.size()));
      leaf_vertices.insert(leaf_vertices.end(), octree.leaf_vertices_.begin() + list[0],
                           octree.leaf_vertices_.begin() + list[1]);
      for (std::size_t i = first_leaf_vertex.back(); subtree != none && i < leaf_vertices.size(); ++i)
        leaf_vertices[i] = subtrees[subtree].vertices[leaf_vertices[i]];
    }
  }
  level_begin.push_back(static_cast<std::uint32_t>(nodes.size()));
  first_leaf_vertex.push_back(static_cast<std::uint32_t>(leaf_vertices.size()));
  leaf_vertices.resize(leaf_vertices.size() + leaf_vertices_ahead, 0);
  boxes_.reserve(nodes.size());
  // From here on, nothing takes memory.
  boxes_.resize(nodes.size());
  nodes_ = std::move(nodes);
  level_begin_ = std::move(level_begin);
  triangles_ = std::move(triangles);
  triangle_ids_ = std::move(ids);
  leaf_corners_ = std::move(corners);
  first_leaf_vertex_ = std::move(first_leaf_vertex);
  leaf_vertices_ = std::move(leaf_vertices);
  triangle_order_.resize(id_count, no_place);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) triangle_order_[triangle_ids_[t]] = t;
  moved_.reset();
}

}  // namespace supple
