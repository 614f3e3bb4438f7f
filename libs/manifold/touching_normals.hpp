#pragma once

#include <span>
#include <vector>

#include "answers/penetration/surface_view.hpp"
#include "queries/feature_name.hpp"
#include "supple/proximity.hpp"
#include "world/object/world_object.hpp"

namespace supple {

/// The data of an object that manifolds read.
struct ManifoldObject {
  SurfaceView surface;
  WorldObject* object = nullptr;
  bool is_solid = false;

  /// The triangles around a vertex.
  std::span<const std::uint32_t> around(std::uint32_t vertex) {
    if (surface.around == nullptr) surface.around = &object->vertex_triangles();
    return surface.around->around(vertex);
  }
};

/// Finds the directions in which two surfaces that touch at a point keep each other apart. The points of a
/// pair say nothing then, so the triangles around them decide.
class TouchingNormals {
 public:
  /// Unit vectors from b to a. One, where a plane lies between the surfaces around the point: the mean of the
  /// normals of the faces in such planes, else of the planes through an edge of each. Several, where one
  /// surface fits into the other one: the normals of the faces that the other surface lies in front of. None,
  /// where the surfaces cross. What a solid bounds is never on the other side of the plane. Valid until the
  /// next call.
  std::span<const Vec3d> find(const ProximityPair& pair, ManifoldObject& a, ManifoldObject& b);

  /// Whether the way between the points of a pair starts inside of a solid.
  bool starts_inside(const ProximityPair& pair, ManifoldObject& a, ManifoldObject& b);

 private:
  /// The surface of one side around the point of a pair. Corners and edges are relative to it.
  struct Around {
    FeatureName feature;
    std::vector<Vec3d> corners, edges;
    std::vector<Vec3d> normals;  // of faces, each direction once
    Vec3d outward;               // their sum
    bool is_solid = false;
  };

  void list(ManifoldObject& object, const FeatureName& feature, const Vec3d& point, Around& around) const;
  FeatureName feature_of(ManifoldObject& object, const ProximityPair& pair, bool is_a);
  bool is_before(const Around& around, const Vec3d& normal) const;
  void add_if_apart(const Vec3d& normal);

  Around a_, b_;
  double rounding_ = 0;  // of heights above planes
  std::vector<Vec3d> normals_;
};

}  // namespace supple
