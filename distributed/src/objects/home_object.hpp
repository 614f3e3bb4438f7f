#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "answers/question.hpp"
#include "bytes.hpp"
#include "core/parallel.hpp"
#include "supple/distributed.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/views.hpp"
#include "world/object/vertex_ways.hpp"

namespace supple {

/// Packed x y z of vertices, in the precision of the user.
struct Coordinates {
  bool is_double = true;
  std::vector<float> floats;
  std::vector<double> doubles;

  void assign(const PositionsView& positions);
  std::size_t size() const { return (is_double ? doubles.size() : floats.size()) / 3; }
  Vec3d operator[](std::size_t i) const {
    if (is_double) return {doubles[3 * i], doubles[3 * i + 1], doubles[3 * i + 2]};
    return {floats[3 * i], floats[3 * i + 1], floats[3 * i + 2]};
  }
  PositionsView view() const { return is_double ? PositionsView(doubles) : PositionsView(floats); }
};

/// What the home of an object says of it with the topology of a cluster: all but static, edges and points.
void write_options(const ObjectOptions& options, Writer& to);
ObjectOptions read_options(Reader& from);

/// An object as `HomeObject::write` wrote it, or all its parts as one.
struct SavedObject {
  ObjectOptions options;
  bool is_part = false, has_motion = false, is_double = false;
  std::vector<Triangle> triangles;             ///< corners as indices into `vertices`, as edges and points
  std::vector<std::uint32_t> faces, vertices;  ///< the user's numbers, ascending
  std::vector<std::uint32_t> groups, masks;    ///< of the vertices; empty without groups
  std::vector<double> start, end;              ///< x y z of the vertices

  /// Calls `visit(start, end)` with the positions in the user's precision.
  template <class Visit>
  void visit_positions(const Visit& visit) const {
    if (is_double) return visit(PositionsView(start), PositionsView(end));
    const std::vector<float> from(start.begin(), start.end()), to(end.begin(), end.end());
    visit(PositionsView(from), PositionsView(to));
  }
};

/// Reads what one or several `HomeObject::write` wrote of one object.
SavedObject read_object(std::span<const std::span<const std::byte>> parts);

/// Neighbouring triangles of an object, and edges and points of no triangle.
struct ClusterTopology {
  std::vector<std::uint32_t> vertices;  ///< ascending
  /// Corners as indices into `vertices`: first the faces, then other elements with repeated corners.
  std::vector<std::array<std::uint16_t, 3>> elements;
  std::vector<std::uint32_t> faces;  ///< the user's numbers
};

/// The vertices are those of the part.
struct Cluster : ClusterTopology {
  Aabb box;               ///< at the last `update_boxes`
  bool is_finite = true;  ///< all vertices, at the last `update_boxes`
  double work = 0;        ///< of the last step, in triangles
};

/// An object, or a part of it, on the rank that added it.
class HomeObject {
 public:
  HomeObject(ObjectId id, const PositionsView& positions, const TrianglesView& triangles,
             const ObjectPart* part, const ObjectOptions& options, std::uint32_t cluster_triangles,
             std::uint32_t addition);
  static HomeObject of(ObjectId id, const SavedObject& saved, std::uint32_t cluster_triangles,
                       std::uint32_t addition);

  void set_positions(const PositionsView& positions);
  void set_motion(const PositionsView& from, const PositionsView& to);
  void set_vertex_groups(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> masks);
  /// The boxes of all clusters, for a search of these shapes. O(n).
  void update_boxes(const SearchedShapes& shapes, const Parallel& parallel);
  /// After `update_boxes`: the vertices that are not finite and that an element uses, as the user's numbers,
  /// ascending.
  void list_non_finite(const SearchedShapes& shapes, std::vector<NonFiniteVertex>& vertices) const;
  /// How far the vertices of a cluster move, without the mean of their ways.
  VertexWays ways_of(const Cluster& cluster) const;

  /// Writes all of it, for `read_object`.
  void write(Writer& to) const;

  /// The user's numbers.
  std::vector<std::uint32_t> vertices_of(const Cluster& cluster) const;
  /// The groups and masks of its vertices; empty without groups.
  std::array<std::vector<std::uint32_t>, 2> groups_of(const Cluster& cluster) const;
  void write_topology(std::uint32_t cluster, Writer& to) const;
  void write_positions(std::uint32_t cluster, Writer& to) const;

  bool is_part() const { return is_part_; }
  bool has_motion() const { return start_.size() != 0; }
  bool has_vertex_groups() const { return !groups_.empty(); }
  /// Whether it has a triangle with three different corners that are finite all the way.
  bool has_finite_face() const;
  std::uint64_t version() const { return version_; }
  /// Those of a part, ascending; empty for a whole object.
  std::span<const std::uint32_t> part_vertices() const { return vertex_ids_; }
  const Coordinates& start() const { return start_; }
  const Coordinates& end() const { return end_; }
  std::size_t vertex_count() const { return vertex_count_; }
  std::uint32_t user_vertex(std::uint32_t v) const { return vertex_ids_.empty() ? v : vertex_ids_[v]; }

  ObjectId id;
  std::uint32_t addition;  ///< `ClusterName::addition`
  ObjectOptions options;
  std::vector<Cluster> clusters;
  // What all ranks that have a part agree on; set when objects were added or removed.
  std::vector<int> homes;  ///< on the first of them; else empty
  Aabb box;                ///< of all parts, on the first home
  int first_home = 0;
  bool is_wide = false;  ///< most ranks have parts

 private:
  void check_count(const PositionsView& positions, const char* call) const;
  bool is_finite_at(const SearchedShapes& shapes, std::uint32_t v) const;
  Aabb box_of(const Cluster& cluster, const SearchedShapes& shapes) const;

  bool is_part_;
  std::vector<std::uint32_t> vertex_ids_;      // of a part
  std::vector<std::uint32_t> groups_, masks_;  // of its vertices; empty without groups
  std::size_t vertex_count_;
  Coordinates start_, end_;  // `start_` is empty at rest
  std::uint64_t version_ = 1;
};

}  // namespace supple
