#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "animation/transform.hpp"
#include "supple/animation.hpp"

namespace supple {

/// A node of the file. Its transform is the matrix, or is composed of the other three when there is none.
struct ModelNode {
  static constexpr std::uint32_t no_parent = 0xffffffff;
  std::uint32_t parent = no_parent;
  std::optional<Transform> matrix{};
  Vec3d translation{};
  Quaternion rotation{0, 0, 0, 1};
  Vec3d scale{1, 1, 1};
  std::vector<double> weights{};  ///< of the morph targets; empty: those of the mesh
};

enum class Animated : std::uint8_t { translation, rotation, scale, weights };
enum class Interpolation : std::uint8_t { step, linear, cubic_spline };

/// The keys of one property of a node.
struct AnimationTrack {
  std::uint32_t node = 0;
  Animated property = Animated::translation;
  std::optional<std::uint32_t> weight{};  ///< of `weights`: the only one that the track animates
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  ///< ascending, at least one
  /// For each key `width()` numbers; for a cubic spline the tangent in, the value and the tangent out.
  std::vector<double> values;

  std::size_t width() const {
    return values.size() / (times.size() * (interpolation == Interpolation::cubic_spline ? 3 : 1));
  }
};

/// How much a vertex follows a joint of its skin.
struct Influence {
  std::uint32_t joint = 0;
  double weight = 0;
  friend bool operator==(const Influence&, const Influence&) = default;
};

struct ModelSkin {
  std::vector<std::uint32_t> joints;    ///< nodes
  std::vector<Transform> inverse_bind;  ///< one for each joint: maps points of the mesh to the joint
};

/// Triangles and their vertices as the file stores them: a primitive of glTF or a mesh of Assimp.
struct Surface {
  std::vector<Vec3d> points;
  std::vector<std::vector<Vec3d>> targets{};         ///< displacements; each as long as `points`
  std::vector<std::vector<Influence>> influences{};  ///< as long as `points`, or empty
  std::vector<Triangle> triangles{};                 ///< indices are below the number of points
  PolygonCounts polygons{};                          ///< that the triangles were
};

/// The vertices of one mesh at one node. They are consecutive vertices of the whole mesh.
struct ModelPart {
  std::uint32_t node = 0;
  Transform local = identity_transform;  ///< before the transform of the node
  std::optional<std::uint32_t> skin{};   ///< then the node's transform does not apply
  std::vector<double> weights{};         ///< of the morph targets, unless the node or a clip has others
  std::size_t first_vertex = 0, vertex_end = 0;
  std::size_t first_triangle = 0, triangle_end = 0;
  std::vector<Vec3d> points{};
  std::vector<std::vector<Vec3d>> targets{};
  std::vector<std::vector<Influence>> influences{};  ///< of the vertices; empty without a skin
};

/// A file with nodes, as its reader fills it.
struct AnimatedModel {
  TriangleMesh mesh;  ///< in the pose at rest after `finish`
  CoordinateFrame frame;
  std::vector<ModelNode> nodes;
  std::vector<ModelSkin> skins;
  std::vector<ModelPart> parts;
  std::vector<AnimationClip> clips;
  std::vector<std::vector<AnimationTrack>> tracks;  ///< of each clip
  /// Computes the positions at a time of a clip, where the library of a format does this. Then the mesh is
  /// complete, and there are no nodes, skins, parts and tracks.
  std::function<void(std::size_t clip, double time, std::span<Vec3d> positions)> evaluate;

  /// Adds the surfaces as one part. Equal vertices become one; vertices of no triangle are left out. `part`
  /// has everything but the vertices. `file` is the name in messages.
  void add_part(ModelPart part, std::span<const Surface> surfaces, const std::string& file);
  /// Puts the mesh into the pose at rest, reverses mirrored triangles, and removes animations of what has no
  /// mesh, such as cameras. Fails when a node is its own ancestor.
  void finish(const std::string& file);

  /// Computes positions: with the tracks of a clip at a time, or at rest with null.
  void pose(const std::vector<AnimationTrack>* played, double time, std::span<Vec3d> positions) const;

 private:
  void remove_idle_tracks();
  /// The transform from each node to the scene.
  std::vector<Transform> to_scene(const std::vector<ModelNode>& posed) const;

  std::vector<std::uint32_t> order_;  ///< the nodes, parents before their children
};

/// Adds counts.
void add(PolygonCounts& sum, const PolygonCounts& more);

/// The value of a track at a time; as many numbers as its width.
std::vector<double> value_at(const AnimationTrack& track, double time);

}  // namespace supple
