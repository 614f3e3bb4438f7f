#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "answers/manifold/manifold_points.hpp"
#include "answers/manifold/touching_normals.hpp"
#include "queries/feature_name.hpp"
#include "supple/manifold.hpp"
#include "supple/result.hpp"

namespace supple {

/// The manifolds of one step, with the names of their points.
struct ManifoldLists {
  /// The features of a and of b at a point; a name that is missing equals no other.
  struct PointName {
    std::array<FeatureName, 2> names{};
    std::array<bool, 2> has_name{};
    constexpr bool operator==(const PointName&) const = default;
  };
  std::vector<Manifold> manifolds;
  std::vector<ManifoldPoint> points;
  std::vector<PointName> names;  // by point

  void clear() {
    manifolds.clear();
    points.clear();
    names.clear();
  }
};

/// Gives the manifolds of a step the ids of those in the step before; see `Manifold`.
class ManifoldMatcher {
 public:
  /// Sets ids and `lasting`, and lists the manifolds of `before` that end. New ids follow `last_id`, which is
  /// raised. O(n log n).
  void match(const ManifoldLists& before, ManifoldLists& now, std::uint64_t& last_id,
             std::vector<EndedManifold>& ended);

 private:
  /// A name of a point of an old manifold.
  struct Key {
    ObjectId a, b;
    std::uint32_t side = 0;
    FeatureName name;
    constexpr auto operator<=>(const Key&) const = default;
  };
  struct NamedManifold {
    Key key;
    std::uint32_t manifold = 0;
    constexpr auto operator<=>(const NamedManifold&) const = default;
  };
  /// An old and a new manifold with features in common.
  struct Common {
    std::uint32_t before = 0, now = 0, count = 0;
    constexpr auto operator<=>(const Common&) const = default;
  };
  struct Center {
    ObjectId a, b;
    Vec3d at;
    std::uint32_t manifold = 0;
  };

  void match_single(const ManifoldLists& before, const ManifoldLists& now);
  void match_by_names(const ManifoldLists& before, const ManifoldLists& now);
  void match_by_places(const ManifoldLists& before, const ManifoldLists& now);
  void match_points(const ManifoldLists& before, const Manifold& old, ManifoldLists& now,
                    const Manifold& manifold);

  std::vector<NamedManifold> named_;
  std::vector<Common> common_;
  std::vector<Center> centers_;  // of old manifolds that nothing continues yet
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> old_of_, new_of_;  // by new and by old manifold, or none
};

/// Finds the manifolds of a step. It keeps its memory between steps.
class ManifoldPass {
 public:
  /// Finds the manifolds of a result, which has the curves and the pairs. `objects` are by index. The lists
  /// are those of the last step until `publish`.
  void find(const DetectResult& result, std::span<const ManifoldObject> objects);
  /// As `find`, for a step without manifolds.
  void find_none();
  /// Does not fail.
  void publish();

  std::span<const Manifold> manifolds() const { return lists_.manifolds; }
  std::span<const ManifoldPoint> points() const { return lists_.points; }
  std::span<const EndedManifold> ended() const { return ended_; }
  /// Calls `visit(list)` for each list of the result.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    visit(lists_.manifolds);
    visit(lists_.points);
    visit(ended_);
  }

 private:
  void add_curve(const DetectResult& result, std::uint32_t index);
  void add_enclosed(const DetectResult& result, const IntersectionCurve& curve, ContactSide side);
  void add_patches(const DetectResult& result, const ContactGroup& group);
  bool list_directions(std::span<const ProximityPair> pairs, const ContactGroup& group);
  void link_pairs(std::span<const ProximityPair> pairs, const ContactGroup& group);
  std::uint32_t place_of(std::uint32_t side, std::uint32_t vertex) const;
  template <class Visit>
  void for_each_vertex(ObjectId object, FeatureKind kind, const std::array<std::uint32_t, 2>& element,
                       const Visit& visit) const;
  bool is_kept_apart(const ProximityPair& pair, double distance, const Vec3d& direction) const;
  template <class Visit>
  void for_each_linked_vertex(const ContactGroup& group, std::uint32_t place, const Visit& visit) const;
  void grow_patch(std::span<const ProximityPair> pairs, const ContactGroup& group, std::uint32_t seed);
  void add_patch(std::span<const ProximityPair> pairs, const ContactGroup& group, std::uint32_t seed);
  template <class NameOf>
  void add_manifold(const Manifold& manifold, const NameOf& name_of);
  void match();

  std::span<const ManifoldObject> objects_;
  ManifoldLists lists_, next_;
  std::vector<EndedManifold> ended_, next_ended_;
  std::uint64_t last_id_ = 0, next_last_id_ = 0;
  ManifoldMatcher matcher_;
  std::vector<ManifoldCandidate> candidates_;
  PointChoice point_choice_;

  static constexpr std::uint32_t none = ~std::uint32_t{0};
  // The pairs of one group.
  /// A direction in which a pair keeps the objects apart. Only surfaces that touch have several.
  struct Direction {
    std::uint32_t pair = 0;  // its place in the group
    bool touches = false;
    bool is_one_of_several = false;
    Vec3d normal;
  };
  struct Vertex {
    std::uint32_t side = 0, vertex = 0;
    std::uint32_t first_use = 0;      // of `uses_`, those of a vertex follow each other
    std::uint32_t scanned_by = none;  // the last patch that looked at its directions
    std::uint32_t linked_by = none;   // the last patch that looked at the triangles around it
  };
  TouchingNormals touching_;
  std::vector<Direction> directions_;
  std::vector<Vertex> vertices_;
  std::array<std::vector<std::uint32_t>, 2> places_;       // by side and vertex
  std::vector<std::uint32_t> uses_;                        // directions, by vertex
  std::vector<std::array<std::uint32_t, 6>> vertices_of_;  // by direction, as places
  std::vector<std::uint8_t> vertex_counts_, is_in_patch_;
  std::vector<std::uint32_t> by_distance_, patch_;
  std::size_t left_ = 0;  // directions in no patch
};

}  // namespace supple
