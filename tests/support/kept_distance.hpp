#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "supple/scene.hpp"
#include "unit/contact/rational_motion.hpp"

// The distance that elements keep in a safe step, and whether a step keeps it, in rational arithmetic.

namespace supple::truth {

/// A vertex and a face, or two edges; an edge or a point is a face with the last vertex repeated.
struct MovingPair {
  std::array<Vec3d, 4> start, end;
  bool are_edges = false;

  Rational squared_distance(const Rational& time) const {
    const auto points = positions_at(start, end, time);
    return are_edges ? squared_distance_of_edges(points) : squared_distance_to_face(points);
  }
  /// The first time within a distance, by algebra that shares no code with the search.
  std::optional<TimeBracket> first_contact(double distance) const {
    return are_edges ? first_contact_by_algebra(EdgeEdgeMotion{start, end}, distance)
                     : first_contact_by_algebra(VertexFaceMotion{start, end}, distance);
  }
};

/// The square of a distance: rational + factor √square.
class KeptSquare {
 public:
  KeptSquare(const MovingPair& pair, double separation, double keep) {
    const Rational square = pair.squared_distance(0), s(separation), k(keep);
    rational_ = k * k * square;
    if (square <= s * s) return;
    rational_ += (1 - k) * (1 - k) * s * s;
    squared_root_ = 4 * (1 - k) * (1 - k) * s * s * k * k * square;
  }
  /// The sign of a distance minus this one.
  int compare(const Rational& squared_distance) const {
    const Rational rest = squared_distance - rational_;
    if (rest < 0) return -1;
    return (rest * rest).compare(squared_root_);
  }
  bool is_zero() const { return rational_ == 0 && squared_root_ == 0; }
  double rounded() const {
    return std::sqrt(static_cast<double>(rational_) + std::sqrt(static_cast<double>(squared_root_)));
  }

 private:
  Rational rational_ = 0, squared_root_ = 0;
};

enum class StepFault { none, too_long, too_short };

/// Checks a step of these pairs, none of which touches at the start: no pair may be nearer than what it keeps
/// at any time up to the step, and if the step is shorter than 1, some pair must be that near within 2^-18
/// more. `by_algebra` also finds pairs that come too near and part again before the step ends; this takes
/// some milliseconds.
inline StepFault check_step(const std::vector<MovingPair>& pairs, double separation, double keep, double step,
                            bool by_algebra = true) {
  // A multiple of a power of two, because rational arithmetic is slow on other numbers.
  const Rational later = std::min(Rational(step) * (1 + Rational(0x1p-18)), Rational(1));
  bool is_reached = step == 1;
  for (const MovingPair& pair : pairs) {
    const KeptSquare kept(pair, separation, keep);
    if (kept.compare(pair.squared_distance(step)) < 0) return StepFault::too_long;
    is_reached = is_reached || kept.compare(pair.squared_distance(later)) <= 0;
  }
  // Elements can come near and part again. Algebra finds that for distances that are doubles.
  for (const MovingPair& pair : pairs) {
    if (!by_algebra && is_reached) break;
    const KeptSquare kept(pair, separation, keep);
    const auto first = pair.first_contact(kept.is_zero() ? 0 : kept.rounded() * (1 - 0x1p-48));
    if (first && step > first->high) return StepFault::too_long;
    is_reached = is_reached || (first && first->high <= later);
  }
  for (const MovingPair& pair : pairs) {
    if (is_reached) return StepFault::none;
    const auto first = pair.first_contact(KeptSquare(pair, separation, keep).rounded() * (1 + 0x1p-48));
    is_reached = first && first->low <= later;
  }
  if (is_reached) return StepFault::none;
  return StepFault::too_short;
}

/// Two objects: a point and a triangle, two edges, or two points.
struct TwoElements {
  std::vector<Vec3d> start_a, end_a, start_b, end_b;

  Scene scene(double separation) const {
    SceneOptions options;
    options.contacts = ContactKinds::continuous;
    options.impact.min_separation = separation;
    Scene scene(options);
    const auto add = [&](const std::vector<Vec3d>& start, const std::vector<Vec3d>& end) {
      TriangleMesh mesh;
      mesh.positions = start;
      ObjectOptions of_object;
      if (start.size() == 1) of_object.points = {0};
      if (start.size() == 2) of_object.edges = {{0, 1}};
      if (start.size() == 3) mesh.triangles = {{0, 1, 2}};
      scene.set_motion(scene.add(mesh, of_object), start, end);
    };
    add(start_a, end_a);
    add(start_b, end_b);
    return scene;
  }

  /// All pairs of elements that the scene tests.
  std::vector<MovingPair> pairs() const {
    std::vector<MovingPair> found;
    if (start_a.size() == 2)
      found.push_back(
          {{start_a[0], start_a[1], start_b[0], start_b[1]}, {end_a[0], end_a[1], end_b[0], end_b[1]}, true});
    const auto add = [&](std::size_t v, const auto& start, const auto& end, const auto& other_start,
                         const auto& other_end) {
      const std::size_t last = other_start.size() - 1, middle = std::min<std::size_t>(1, last);
      found.push_back({{start[v], other_start[0], other_start[middle], other_start[last]},
                       {end[v], other_end[0], other_end[middle], other_end[last]},
                       false});
    };
    for (std::size_t v = 0; v < start_a.size(); ++v) add(v, start_a, end_a, start_b, end_b);
    for (std::size_t v = 0; start_b.size() > 1 && v < start_b.size(); ++v)
      add(v, start_b, end_b, start_a, end_a);
    return found;
  }
};

inline bool touch_at_start(const std::vector<MovingPair>& pairs) {
  for (const MovingPair& pair : pairs) {
    if (pair.squared_distance(0) == 0) return true;
  }
  return false;
}

}  // namespace supple::truth
