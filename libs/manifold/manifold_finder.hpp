#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "answers/penetration/manifold_methods.hpp"
#include "manifold/touching_normals.hpp"
#include "supple/manifold.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// The manifolds of one step, with the names of their points.
struct ManifoldLists {
  /// Numbers of the features of a and of b at a point; `no_name` where it has none.
  using PointName = std::array<std::uint64_t, 2>;
  static constexpr std::uint64_t no_name = ~std::uint64_t{0};
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
  /// raised.
  void match(const ManifoldLists& before, ManifoldLists& now, std::uint64_t& last_id,
             std::vector<EndedManifold>& ended);

 private:
  /// The manifolds of two objects in a list.
  struct Range {
    std::uint32_t begin = 0, end = 0;
  };
  struct NamedManifold {
    std::uint64_t name = 0;
    std::uint32_t side = 0, manifold = 0;
    constexpr auto operator<=>(const NamedManifold&) const = default;
  };
  /// An old and a new manifold.
  struct Candidate {
    int minus_common = 0;  // features
    double distance = 0;
    std::uint32_t before = 0, now = 0;
    constexpr auto operator<=>(const Candidate&) const = default;
  };

  void match_several(const ManifoldLists& before, const Range& old, const ManifoldLists& now,
                     const Range& found);

  std::vector<NamedManifold> named_;
  std::vector<Candidate> candidates_;
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> old_of_, new_of_;  // by new and by old manifold of two objects, or none
};

/// Keeps its memory between steps.
class ManifoldFinder : public ManifoldMaker {
 public:
  void find(const DetectResult& result, const World& world, bool lists_all_pairs) override;
  void publish(DetectResult& result) override;
  void keep(KeptLists& kept) override;

 private:
  /// A point that may span a manifold.
  struct Candidate {
    double x = 0, y = 0, scaled_depth = 0;  // in the plane at right angles to the normal
    std::uint32_t record = 0;               // a pair, or a place in `named_`
  };
  /// A point of a curve.
  struct NamedPoint {
    Vec3d position;
    double depth = 0;
    ManifoldLists::PointName name;
  };
  class Collector;
  /// Places of candidates.
  struct Choice {
    std::array<std::size_t, 4> chosen{};
    std::uint32_t count = 0;
  };
  /// A direction in which a pair keeps the objects apart. Only surfaces that touch have several.
  struct Direction {
    Vec3d normal;
    double distance = 0;
    std::uint32_t pair = 0;  // its place in the group
    bool touches = false, is_one_of_several = false;
  };
  void add_curve(const DetectResult& result, std::uint32_t index);
  void add_patches(const DetectResult& result, const ContactGroup& group);
  bool is_kept_apart(const ProximityPair& pair, double distance, const Vec3d& direction) const;
  template <class DirectionOf>
  void add_patch(std::span<const ProximityPair> pairs, const ContactGroup& group, const Direction& nearest,
                 bool has_nearest, std::size_t count, const DirectionOf& direction_of);
  static Choice choose_points(std::span<const Candidate> candidates, std::size_t first);
  template <class Fill>
  void add_manifold(const Manifold& manifold, const Collector& found, const Fill& fill);
  ManifoldObject& object_of(ObjectId id);

  const World* world_ = nullptr;
  std::vector<ManifoldObject> objects_;  // by slot, made when they are needed
  ManifoldLists lists_, next_;
  std::vector<EndedManifold> ended_, next_ended_;
  std::uint64_t last_id_ = 0, next_last_id_ = 0;
  ManifoldMatcher matcher_;
  TouchingNormals touching_;
  std::vector<Candidate> candidates_;
  std::vector<NamedPoint> named_;
  double size_ = 0;  // of the coordinates of the points
  bool lists_all_pairs_ = false;
  std::vector<Direction> directions_, left_;  // of the pairs of one group
};

}  // namespace supple
