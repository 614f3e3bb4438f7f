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
#include "contact/impact/first_impact.hpp"
#include "contact/impact/parting.hpp"
#include "core/sort_once.hpp"
#include "mesh/vertex_triangles.hpp"

namespace supple {
void ImpactPass::add_near(std::uint32_t job, ElementPairKind kind, const OpenPair& pair, bool touches,
                          Worker& worker) {
  const MovingObject &a = objects_[jobs_[job].a], &b = objects_[jobs_[job].b];
  const std::optional<ElementNames> names = names_of(kind, pair.candidate, pair.vertices, a, b);
  if (!names) return;
  worker.near.push_back({{job, 0, {a.id, b.id, names->kind, names->a, names->b}},
                         touches,
                         names->is_turned,
                         pair.vertices,
                         pair.motion});
}

std::vector<std::uint32_t> ImpactPass::list_near() {
  const auto first = static_cast<std::uint32_t>(near_.size());
  for (const Worker& worker : workers_) near_.insert(near_.end(), worker.near.begin(), worker.near.end());
  std::vector<std::uint32_t> listed(near_.size() - first);
  std::iota(listed.begin(), listed.end(), first);
  std::sort(near_.begin() + first, near_.end(),
            [](const NearPair& p, const NearPair& q) { return limits_before(p.limit, q.limit); });
  return listed;
}

void ImpactPass::limit_near(std::span<const std::uint32_t> pairs, std::optional<double> failing,
                            const Parallel& parallel) {
  std::map<std::uint32_t, VertexTriangles> around;  // by slot
  const auto for_each_face = [&](std::uint32_t slot, std::span<const std::uint32_t> vertices,
                                 const auto& visit) {
    const std::span faces(objects_[slot].view.moving.face_ids, objects_[slot].triangle_ids.size());
    const auto of_slot =
        around.try_emplace(slot, faces, std::span<const std::uint8_t>(), objects_[slot].vertex_ids.size());
    for (const std::uint32_t face : of_slot.first->second.around(vertices[0])) {
      const auto is_corner = [&](std::uint32_t v) { return std::ranges::count(faces[face], v) > 0; };
      if (std::ranges::all_of(vertices, is_corner)) visit(face);
    }
  };
  struct TrianglesOfJob {
    std::uint32_t job, a, b;
    std::uint32_t pair;  // the first of `near_` with these triangles
    auto operator<=>(const TrianglesOfJob&) const = default;
  };
  std::vector<TrianglesOfJob> triangles;
  for (const std::uint32_t i : pairs) {
    const NearPair& near = near_[i];
    if (!near.touches) continue;
    const auto [a, b] = jobs_[near.limit.job];
    const std::span<const std::uint32_t> all(near.vertices);
    const std::size_t count = near.motion.are_edges ? 2 : 1;
    for_each_face(near.is_turned ? b : a, all.first(count), [&](std::uint32_t p) {
      for_each_face(near.is_turned ? a : b, all.subspan(count), [&](std::uint32_t q) {
        triangles.push_back({near.limit.job, near.is_turned ? q : p, near.is_turned ? p : q, i});
      });
    });
  }
  sort_once(triangles);
  const auto is_same = [](const TrianglesOfJob& p, const TrianglesOfJob& q) {
    return p.job == q.job && p.a == q.a && p.b == q.b;
  };
  triangles.erase(std::unique(triangles.begin(), triangles.end(), is_same), triangles.end());

  /// Replaces ends by rounded positions. Returns whether there is something new to decide.
  const auto round_ends = [&](auto& motion, std::uint32_t job) {
    bool is_new = !failing;
    for (std::size_t i = 0; failing && i < motion.end.size(); ++i) {
      const Vec3d& from = motion.start[i];
      const Vec3d to = rounded_position(from, motion.end[i], safe_[island_of(mover_of(job))].step);
      is_new = is_new || to != motion.end[i];
      motion.end[i] = to;
    }
    return is_new;
  };
  const auto triangle_of = [&](std::uint32_t slot, std::uint32_t face) {
    const MovingObject& object = objects_[slot];
    MovingTriangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = object.view.moving.face_ids[face][i];
      triangle.start[i] = placed((*object.start)[vertex], object);
      triangle.end[i] = placed((*object.end)[vertex], object);
    }
    triangle.moves = moves(slot);
    return triangle;
  };
  std::vector<double> times(near_.size(), 1);
  std::vector<std::uint8_t> fails(triangles.size(), 0);
  parallel.for_ranges(triangles.size(), 16, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end && !stop_.stop_requested(); ++i) {
      const auto& [job, a, b, pair] = triangles[i];
      MovingTriangle of_a = triangle_of(jobs_[job].a, a), of_b = triangle_of(jobs_[job].b, b);
      const bool is_new_a = round_ends(of_a, job), is_new_b = round_ends(of_b, job);
      fails[i] = (is_new_a || is_new_b) && !part_after_start(of_a, of_b) ? 1 : 0;
    }
  });
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (fails[i] != 0) times[triangles[i].pair] = failing.value_or(0);
  }
  parallel.for_ranges(pairs.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end && !stop_.stop_requested(); ++i) {
      const NearPair& pair = near_[pairs[i]];
      ElementMotion motion = pair.motion;
      double& time = times[pairs[i]];
      if (!(pair.touches || failing) || time == 0 || !round_ends(motion, pair.limit.job)) continue;
      bool used_exact = false;
      if (!pair.touches) {
        const RelativeMotion relative = relative_motion(motion);
        if (first_time_within(motion, relative, 0, options_.impact.exact, used_exact)) time = *failing;
      } else if (const std::optional<TimeBracket> next = exact_next_contact(motion)) {
        time = std::min(time, failing.value_or(next->low));
      }
    }
  });
  for (const std::uint32_t i : pairs) {
    if (times[i] == 1) continue;
    limits_.push_back(near_[i].limit);
    limits_.back().time = times[i];
  }
  std::sort(limits_.begin(), limits_.end(), limits_before);
}

}  // namespace supple
