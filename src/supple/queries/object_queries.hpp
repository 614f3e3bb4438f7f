#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contact/distance/distance_kernels.hpp"
#include "contact/distance/ray_triangle.hpp"
#include "core/stop_signal.hpp"
#include "narrow_phase/ordered_descent.hpp"
#include "narrow_phase/overlap_kernels.hpp"
#include "narrow_phase/query_kernels.hpp"
#include "narrow_phase/recent_leaf_boxes.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/mesh.hpp"
#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

class NearestTriangle;

/// What queries read of one object at rest, whose octree is refitted.
struct QueriedObject {
  ObjectId id;
  OctreeView view;
  const VertexBuffer* positions = nullptr;
  std::span<const Triangle> triangles;  ///< in octree order
  std::span<const std::uint32_t> triangle_ids;
  Aabb box;  ///< of the placed object
  bool has_inert_faces = false;
  const QueryBox* fine_boxes = nullptr;  ///< eight for each node; null where the octree's boxes serve as well

  /// The placed corners of a triangle in octree order.
  TrianglePoints corners(std::uint32_t triangle) const;
  /// The box of the placed triangles of a child; inverted when it has none that is finite.
  QueryBox child_box(std::uint32_t node, int child) const;
  LeafArrays leaves() const { return {view.arrays, view.boxes, view.leaf_vertices}; }
};

/// From this ratio of distance and size on, distances in single precision hardly tell triangles apart.
constexpr double far_ratio = 0x1p8;
/// Whether something at this distance is farther away than `ratio` times the size of the box.
bool is_far(const Aabb& box, double distance, double ratio);

/// A point as the boxes of an object's octree see it: between two floats on each axis, without the
/// translation.
Aabb seen_by(const QueriedObject& object, const Vec3d& point);

/// A triangle, by object in a list of objects and in octree order, and at most its distance to a point.
struct NearTriangle {
  double distance = 0;
  std::uint32_t object = 0, triangle = 0;
};

/// A point and its nearest triangle.
struct FoundTriangle {
  Vec3d point;
  TrianglePoints corners;
  std::uint32_t object = 0, triangle = 0,
                id = 0;  ///< by object in a list of objects, in octree order, the user's

  ElementPoints elements() const { return {{point, corners[0], corners[1], corners[2]}, 1, 3}; }
};

/// A triangle on a ray: its place on the ray, its object in a list of objects, and the user's number.
struct TriangleOnRay {
  RayParameter parameter;
  std::uint32_t object = 0, id = 0;
};

/// Answers queries to a list of objects, one after the other. Holds the memory of one worker.
class ObjectQueries {
 public:
  /// Call before queries to another list of objects, or after they changed. After a request to stop, queries
  /// end early, and their results are of no use.
  void start(const StopSignal& stop = {});
  /// The nearest triangle of a finite point; of several, the first by object and number. Computes nothing
  /// that the decision does not need. Looks first at the triangle that was nearest to the point before: for
  /// points that are close to each other, hardly any other triangle is nearer.
  std::optional<FoundTriangle> nearest(std::span<const QueriedObject> objects, const Vec3d& point,
                                       double max_distance);
  /// The same for at most `PointPacket::capacity` points, which are best close to each other.
  void nearest(std::span<const QueriedObject> objects, std::span<const Vec3d> points, double max_distance,
               std::span<std::optional<FoundTriangle>> found);
  /// How many triangles `nearest` and the rays have decided exactly.
  std::uint64_t decided() const { return decided_; }
  /// How many triangles `nearest` has bounded.
  std::uint64_t bounded() const { return bounded_; }
  std::optional<RayHit> cast(std::span<const QueriedObject> objects, const Ray& ray, bool count_hits);
  /// Appends all triangles on the ray, ordered by t, object and triangle.
  void cast_all(std::span<const QueriedObject> objects, const Ray& ray, std::uint32_t query,
                std::vector<ListedRayHit>& found);
  /// Appends the triangles that overlap the region.
  void overlaps(std::span<const QueriedObject> objects, const QueryBox& box, std::uint32_t query,
                std::vector<Overlap>& found);
  void overlaps(std::span<const QueriedObject> objects, const QuerySphere& sphere, std::uint32_t query,
                std::vector<Overlap>& found);
  /// `index` is a number of the caller. Objects with an inert triangle contain nothing.
  Containment inside(std::uint32_t index, const QueriedObject& object, const Vec3d& point);

 private:
  bool bound_triangles(const QueriedObject& object, std::span<const Vec3d> points, std::span<double> limits);
  template <class Chosen, class Visit>
  void visit_leaf(std::uint32_t index, const QueriedObject& object, std::uint32_t leaf, std::uint32_t begin,
                  std::uint32_t end, const Chosen& chosen, const Visit& visit);
  static void bound_children(const QueriedObject& object, std::uint32_t node, const Vec3d& point,
                             const Aabb& seen, const NearestTriangle& nearest,
                             std::array<double, node_width>& bounds);
  static std::optional<std::uint32_t> frontmost_triangle(const QueriedObject& object, const Vec3d& point);
  /// Calls `visit` with the triangles of an object whose boxes overlap the region, in octree order within
  /// leaves.
  template <class Visit>
  void visit_overlapping(std::uint32_t index, const QueriedObject& object, const QueryBox& region,
                         const Visit& visit);
  template <class Visit>
  void visit_triangles_on_ray(std::span<const QueriedObject> objects, const Ray& ray, const double& limit,
                              const Visit& visit);
  /// The objects with a bound of at most `limit`, the smallest first.
  template <class BoundOf>
  void order(std::span<const QueriedObject> objects, const BoundOf& bound_of, double limit);

  StopSignal stop_;
  std::uint64_t decided_ = 0, bounded_ = 0;
  std::optional<FoundTriangle> last_nearest_;
  std::vector<TriangleOnRay> on_ray_;  // of `cast_all`
  std::vector<NearTriangle> candidates_;
  PointsBlock block_{};  // of the nearest triangle
  OrderedDescent descent_;
  std::vector<std::uint32_t> nodes_;
  RecentLeaves<LeafBoxes> recent_;
  RecentLeaves<LeafCorners> recent_corners_;
  // Triangles with the numbers of points, and their bounds; the candidates of each point.
  std::vector<TrianglePair> near_;
  std::vector<float> squares_;
  std::vector<double> lower_, upper_;
  std::array<std::vector<NearTriangle>, PointPacket::capacity> of_points_;
  std::vector<std::pair<double, std::uint32_t>> order_;
};

}  // namespace supple
