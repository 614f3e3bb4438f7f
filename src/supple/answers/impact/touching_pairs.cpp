// Elements that share a point at the start of a step, in `ImpactPass`.
//
// Two triangles that share a point have two elements that do, unless an edge of one cuts through the other.
// So the triangles around the touching elements are all that touch. Each two of them must part or slide just
// after the start. Then the surfaces do not cross there, and a later crossing needs two elements that touch
// again or that are apart at the start. Elements whose vertices stay in one plane cannot change sides.

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "answers/impact/impact_pass.hpp"
#include "contact/impact/exact_impact.hpp"
#include "contact/impact/parting.hpp"
#include "core/sort_once.hpp"

namespace supple {
namespace {

/// The faces of an object by their vertices.
class FacesOfVertices {
 public:
  explicit FacesOfVertices(const MovingObject& object)
      : faces_(object.view.moving.face_ids, object.triangle_ids.size()),
        first_(object.vertex_ids.size() + 1) {
    for (const Triangle& face : faces_) {
      for (const std::uint32_t vertex : face) ++first_[vertex];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    numbers_.resize(first_.back());
    for (std::uint32_t face = 0; face < faces_.size(); ++face) {
      for (const std::uint32_t vertex : faces_[face]) numbers_[--first_[vertex]] = face;
    }
  }

  /// Calls `visit(face)` for the faces with all of these vertices, some twice where corners are repeated.
  template <class Visit>
  void for_each(std::span<const std::uint32_t> vertices, const Visit& visit) const {
    for (std::uint32_t i = first_[vertices[0]]; i < first_[vertices[0] + 1]; ++i) {
      const Triangle& face = faces_[numbers_[i]];
      if (std::ranges::all_of(vertices, [&](std::uint32_t v) { return std::ranges::count(face, v) > 0; }))
        visit(numbers_[i]);
    }
  }

 private:
  std::span<const Triangle> faces_;
  std::vector<std::uint32_t> first_, numbers_;
};

}  // namespace

void ImpactPass::add_touching(std::uint32_t job, ElementPairKind kind, const OpenPair& pair, Worker& worker) {
  const MovingObject &a = objects_[jobs_[job].a], &b = objects_[jobs_[job].b];
  const std::optional<ElementNames> names = names_of(kind, pair.candidate, pair.vertices, a, b);
  if (!names) return;
  worker.touching.push_back({{job, 0, {a.id, b.id, names->kind, names->a, names->b}},
                             names->is_turned,
                             pair.vertices,
                             pair.motion});
}

/// Adds what the workers have found to `touching_`, in canonical order.
void ImpactPass::list_touching() {
  for (const Worker& worker : workers_)
    touching_.insert(touching_.end(), worker.touching.begin(), worker.touching.end());
  std::sort(touching_.begin(), touching_.end(),
            [](const auto& p, const auto& q) { return limits_before(p.limit, q.limit); });
}

void ImpactPass::limit_touching(std::span<const std::uint32_t> jobs, bool rounded, double failing,
                                const Parallel& parallel) {
  std::map<std::uint32_t, FacesOfVertices> faces;  // by slot
  const auto faces_of = [&](std::uint32_t slot) -> const FacesOfVertices& {
    return faces.try_emplace(slot, objects_[slot]).first->second;
  };
  struct TrianglePairOfJob {
    std::uint32_t job, a, b;
    std::uint32_t pair;  // the first of `touching_` with these triangles
    auto operator<=>(const TrianglePairOfJob&) const = default;
  };
  std::vector<TrianglePairOfJob> triangles;
  std::vector<std::uint32_t> pairs;
  for (std::uint32_t i = 0; i < touching_.size(); ++i) {
    const auto& [limit, is_turned, vertices, motion] = touching_[i];
    if (!std::ranges::binary_search(jobs, limit.job)) continue;
    pairs.push_back(i);
    const ContactJob& job = jobs_[limit.job];
    const std::span<const std::uint32_t> all(vertices);
    const std::size_t count = motion.are_edges ? 2 : 1;
    faces_of(is_turned ? job.b : job.a).for_each(all.first(count), [&](std::uint32_t first) {
      faces_of(is_turned ? job.a : job.b).for_each(all.subspan(count), [&](std::uint32_t second) {
        triangles.push_back({limit.job, is_turned ? second : first, is_turned ? first : second, i});
      });
    });
  }
  sort_once(triangles);
  const auto is_same = [](const auto& p, const auto& q) {
    return p.job == q.job && p.a == q.a && p.b == q.b;
  };
  triangles.erase(std::unique(triangles.begin(), triangles.end(), is_same), triangles.end());

  const auto part_of = [&](std::uint32_t job) { return rounded ? safe_[island_of(mover_of(job))].step : 1; };
  const auto triangle_of = [&](std::uint32_t slot, std::uint32_t face, std::uint32_t job) {
    const MovingObject& object = objects_[slot];
    MovingTriangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = object.view.moving.face_ids[face][i];
      triangle.start[i] = placed((*object.start)[vertex], object);
      triangle.end[i] = placed((*object.end)[vertex], object);
      if (rounded) triangle.end[i] = rounded_position(triangle.start[i], triangle.end[i], part_of(job));
    }
    triangle.moves = moves(slot);
    return triangle;
  };
  std::vector<double> times(touching_.size(), 1);
  std::vector<std::uint8_t> fails(triangles.size(), 0);
  parallel.for_ranges(triangles.size(), 16, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end && !stop_.stop_requested(); ++i) {
      const auto& [job, a, b, pair] = triangles[i];
      const MovingTriangle of_a = triangle_of(jobs_[job].a, a, job), of_b = triangle_of(jobs_[job].b, b, job);
      fails[i] = part_after_start(of_a, of_b) ? 0 : 1;
    }
  });
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (fails[i] != 0) times[triangles[i].pair] = failing;
  }
  parallel.for_ranges(pairs.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end && !stop_.stop_requested(); ++i) {
      const TouchingPair& pair = touching_[pairs[i]];
      ElementMotion motion = pair.motion;
      for (std::size_t v = 0; rounded && v < 4; ++v)
        motion.end[v] = rounded_position(motion.start[v], motion.end[v], part_of(pair.limit.job));
      const std::optional<TimeBracket> next = exact_next_contact(motion);
      if (next) times[pairs[i]] = std::min(times[pairs[i]], rounded ? failing : next->low);
    }
  });
  for (const std::uint32_t i : pairs) {
    if (times[i] == 1) continue;
    limits_.push_back(touching_[i].limit);
    limits_.back().time = times[i];
  }
  std::sort(limits_.begin(), limits_.end(), limits_before);
}

}  // namespace supple
