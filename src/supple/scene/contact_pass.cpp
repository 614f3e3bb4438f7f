#include "scene/contact_pass.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "supple/triangle_intersection.hpp"

namespace supple {
namespace {

Vec3d position(const OctreeView& view, std::uint32_t vertex) {
  const auto at = [&](const auto& vertices) {
    return Vec3d{vertices[vertex][0], vertices[vertex][1], vertices[vertex][2]};
  };
  const TriangleArrays& arrays = view.arrays;
  return (arrays.doubles.data != nullptr ? at(arrays.doubles) : at(arrays.floats)) + view.translation;
}

TrianglePoints points_of(const OctreeView& view, std::uint32_t triangle) {
  const Triangle& corners = view.arrays.triangles[triangle];
  return {position(view, corners[0]), position(view, corners[1]), position(view, corners[2])};
}

void set_corners(float (&rows)[9][TrianglePairBlock<float>::capacity], std::size_t place,
                 const TriangleArrays& arrays, std::uint32_t triangle) {
  std::size_t row = 0;
  for (const std::uint32_t vertex : arrays.triangles[triangle]) {
    const float* const corner = arrays.floats[vertex];
    for (int axis = 0; axis < 3; ++axis) rows[row++][place] = corner[axis];
  }
}

}  // namespace

void ContactPass::run(std::span<const ContactJob> jobs, std::span<const ContactObject> objects,
                      const SceneOptions& options, const Parallel& parallel, StepStats& stats) {
  objects_ = objects;
  options_ = options;
  parallel_ = &parallel;
  workers_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.found.clear();
    worker.points.clear();
    worker.leaves.clear();
    worker.stats = {};
  }
  Timer timer;
  plan_outcomes(jobs);
  tasks_.plan(static_cast<std::uint32_t>(jobs_.size()), workers_.size(), workers_[0].traversal,
              [&](std::uint32_t job) { return view_of_job(job); });
  tasks_.run(parallel, workers_, [&](const ContactTask& task, Worker& worker) { run_task(task, worker); });
  add_stats(workers_, timer.lap(), stats);
  gather_contacts();
  gather_colliding_vertices();
  stats.contacts = contacts_.size();
  stats.finish_seconds += timer.lap();
}

/// Splits the jobs into those to be done and those whose outcome is known. Both lists ascend.
void ContactPass::plan_outcomes(std::span<const ContactJob> jobs) {
  outcomes_.swap(last_outcomes_);
  if (!is_complete_) last_outcomes_.clear();
  is_complete_ = false;
  outcomes_.clear();
  sources_.clear();
  jobs_.clear();
  std::uint32_t last = 0;
  for (const ContactJob& job : jobs) {
    const auto precedes = [&](const ContactJob& other) {
      return other.a != job.a ? other.a < job.a : other.b < job.b;
    };
    while (last < last_outcomes_.size() && precedes(last_outcomes_[last].job)) ++last;
    const Outcome outcome{job, objects_[job.a].version, objects_[job.b].version, 0, 0};
    outcomes_.push_back(outcome);
    // The vertices of colliding leaves are not kept.
    const bool is_known = !options_.colliding_vertices && last < last_outcomes_.size() &&
                          last_outcomes_[last].job.a == job.a && last_outcomes_[last].job.b == job.b &&
                          last_outcomes_[last].version_a == outcome.version_a &&
                          last_outcomes_[last].version_b == outcome.version_b;
    sources_.push_back(is_known ? last : none);
    if (!is_known) jobs_.push_back(job);
  }
}

ObjectPairView ContactPass::view_of_job(std::uint32_t job) const {
  const ContactObject& a = objects_[jobs_[job].a];
  if (jobs_[job].a == jobs_[job].b) return self_pair_of(a.view);
  return pair_of(a.view, objects_[jobs_[job].b].view);
}

void ContactPass::run_task(const ContactTask& task, Worker& worker) const {
  const ObjectPairView pair = view_of_job(task.job);
  const auto on_leaves = [&](std::span<const LeafPair> leaf_pairs) {
    if (!options_.colliding_vertices) return;
    for (const LeafPair& leaves : leaf_pairs) worker.leaves.push_back({task.job, leaves});
  };
  const auto on_candidates = [&](std::span<const TrianglePair> candidates) {
    if (options_.contacts == ContactMode::none) return;
    Timer timer;
    test_candidates(task.job, pair, candidates, worker);
    worker.stats.exact_seconds += timer.lap();
  };
  worker.traversal.find_triangle_pairs(pair, task.root, worker.stats.traversal, on_leaves, on_candidates);
}

/// Floating point decides all but few candidates, a block of them at a time in vector lanes.
void ContactPass::test_candidates(std::uint32_t job, const ObjectPairView& pair,
                                  std::span<const TrianglePair> candidates, Worker& worker) const {
  constexpr std::size_t capacity = TrianglePairBlock<float>::capacity;
  const ContactObject& a = objects_[jobs_[job].a];
  for (std::size_t first = 0; first < candidates.size(); first += capacity) {
    const auto part = candidates.subspan(first, std::min(capacity, candidates.size() - first));
    std::array<TrianglePair, capacity> ordered;
    for (std::size_t k = 0; k < part.size(); ++k) {
      ordered[k] = part[k];
      // The exact stage sees triangles in the order of the results, so that nothing depends on the octrees'
      // shape.
      if (pair.same_object && a.triangle_ids[part[k].a] > a.triangle_ids[part[k].b]) {
        std::swap(ordered[k].a, ordered[k].b);
      }
    }
    const PairVerdicts verdicts = filter_candidates(pair, {ordered.data(), part.size()}, worker);
    std::uint64_t undecided = ~verdicts.apart;
    if (part.size() < capacity) undecided &= (std::uint64_t{1} << part.size()) - 1;
    for (; undecided != 0; undecided &= undecided - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(undecided));
      if ((verdicts.crossing >> k & 1) != 0 && !options_.contact_points) {
        add_contact(job, ordered[k], IntersectionKind::segment, 2, worker);
      } else {
        test_candidate(job, pair, ordered[k], worker);
      }
    }
  }
}

PairVerdicts ContactPass::filter_candidates(const ObjectPairView& pair,
                                            std::span<const TrianglePair> candidates, Worker& worker) const {
  const auto is_single = [](const OctreeView& view) {
    return view.arrays.floats.data != nullptr && view.translation == Vec3d{};
  };
  if (is_single(pair.a) && is_single(pair.b)) {
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      set_corners(worker.floats.a, k, pair.a.arrays, candidates[k].a);
      set_corners(worker.floats.b, k, pair.b.arrays, candidates[k].b);
    }
    return filter_pairs(worker.floats, candidates.size());
  }
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    worker.doubles.set(k, points_of(pair.a, candidates[k].a), points_of(pair.b, candidates[k].b));
  }
  return filter_pairs(worker.doubles, candidates.size());
}

void ContactPass::test_candidate(std::uint32_t job, const ObjectPairView& pair, TrianglePair candidate,
                                 Worker& worker) const {
  const TriangleIntersection shared =
      intersect_triangles(points_of(pair.a, candidate.a), points_of(pair.b, candidate.b));
  worker.stats.exact_fallbacks += shared.used_exact_fallback ? 1 : 0;
  if (!shared.intersects) return;
  add_contact(job, candidate, shared.kind, shared.point_count, worker);
  if (options_.contact_points) {
    const auto points = shared.extreme_points();
    worker.points.insert(worker.points.end(), points.begin(), points.end());
  }
}

void ContactPass::add_contact(std::uint32_t job, TrianglePair pair, IntersectionKind kind,
                              std::uint8_t point_count, Worker& worker) const {
  const ContactObject& a = objects_[jobs_[job].a];
  const ContactObject& b = objects_[jobs_[job].b];
  const Contact contact{a.id,
                        b.id,
                        a.triangle_ids[pair.a],
                        b.triangle_ids[pair.b],
                        kind,
                        point_count,
                        static_cast<std::uint32_t>(worker.points.size())};
  worker.found.push_back({job, contact});
}

/// Jobs are in order already: contacts are counted into them, and sorted within.
void ContactPass::sort_found() {
  first_of_job_.assign(jobs_.size() + 2, 0);
  for (const Worker& worker : workers_) {
    for (const Found& found : worker.found) ++first_of_job_[found.job + 2];
  }
  for (std::size_t job = 2; job < first_of_job_.size(); ++job) first_of_job_[job] += first_of_job_[job - 1];
  keys_.resize(first_of_job_.back());
  for (std::uint32_t w = 0; w < workers_.size(); ++w) {
    for (std::uint32_t i = 0; i < workers_[w].found.size(); ++i) {
      const Found& found = workers_[w].found[i];
      const std::uint64_t place = std::uint64_t{found.contact.triangle_a} << 32 | found.contact.triangle_b;
      keys_[first_of_job_[found.job + 1]++] = {place, w, i};
    }
  }
  first_of_job_.pop_back();
  parallel_->for_ranges(jobs_.size(), 16, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t job = begin; job < end; ++job) {
      std::sort(keys_.begin() + first_of_job_[job], keys_.begin() + first_of_job_[job + 1],
                [](const SortKey& p, const SortKey& q) { return p.place < q.place; });
    }
  });
}

void ContactPass::gather_contacts() {
  sort_found();
  contacts_.swap(last_contacts_);
  points_.swap(last_points_);
  groups_.clear();
  points_.clear();
  std::uint32_t job = 0, total = 0;
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    Outcome& outcome = outcomes_[i];
    outcome.first_contact = total;
    outcome.contact_count = sources_[i] != none ? last_outcomes_[sources_[i]].contact_count
                                                : first_of_job_[job + 1] - first_of_job_[job];
    if (sources_[i] == none) ++job;
    total += outcome.contact_count;
  }
  contacts_.resize(total);
  job = 0;
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    const Outcome& outcome = outcomes_[i];
    const std::uint32_t first_key = sources_[i] == none ? first_of_job_[job++] : 0;
    if (outcome.contact_count == 0) continue;
    groups_.push_back({objects_[outcome.job.a].id, objects_[outcome.job.b].id, outcome.first_contact,
                       outcome.contact_count});
    for (std::uint32_t k = 0; k < outcome.contact_count; ++k) {
      Contact& contact = contacts_[outcome.first_contact + k];
      if (sources_[i] != none) {
        contact = last_contacts_[last_outcomes_[sources_[i]].first_contact + k];
        append_points(last_points_.data(), contact);
      } else {
        const Worker& worker = workers_[keys_[first_key + k].worker];
        contact = worker.found[keys_[first_key + k].index].contact;
        append_points(worker.points.data(), contact);
      }
    }
  }
  is_complete_ = true;
}

/// The contact's points, whose first is told by it, go to the end of all; it then tells where they are.
void ContactPass::append_points(const ContactPoint* points, Contact& contact) {
  if (!options_.contact_points) return;
  const ContactPoint* const first = points + contact.first_point;
  contact.first_point = static_cast<std::uint32_t>(points_.size());
  points_.insert(points_.end(), first, first + contact.point_count);
}

void ContactPass::gather_colliding_vertices() {
  vertex_groups_.clear();
  vertices_.clear();
  if (!options_.colliding_vertices) return;
  leaves_.clear();
  for (const Worker& worker : workers_)
    leaves_.insert(leaves_.end(), worker.leaves.begin(), worker.leaves.end());
  // The vertices of a job are a set: the order of its leaves does not matter.
  std::sort(leaves_.begin(), leaves_.end(),
            [](const CollidingLeaves& p, const CollidingLeaves& q) { return p.job < q.job; });
  for (auto first = leaves_.begin(); first != leaves_.end();) {
    const std::uint32_t job = first->job;
    const auto last =
        std::find_if(first, leaves_.end(), [&](const auto& leaves) { return leaves.job != job; });
    CollidingVertices group{objects_[jobs_[job].a].id, objects_[jobs_[job].b].id,
                            static_cast<std::uint32_t>(vertices_.size()), 0, 0};
    append_marked_vertices(jobs_[job].a, {first, last}, false);
    group.count_a = static_cast<std::uint32_t>(vertices_.size()) - group.first_vertex;
    append_marked_vertices(jobs_[job].b, {first, last}, true);
    group.count_b = static_cast<std::uint32_t>(vertices_.size()) - group.first_vertex - group.count_a;
    vertex_groups_.push_back(group);
    first = last;
  }
}

void ContactPass::append_marked_vertices(std::uint32_t object, std::span<const CollidingLeaves> leaves,
                                         bool side_b) {
  const ContactObject& owner = objects_[object];
  marked_.assign(owner.vertex_count, 0);
  for (const CollidingLeaves& pair : leaves) {
    const std::uint32_t begin = side_b ? pair.leaves.begin_b : pair.leaves.begin_a;
    const std::uint32_t end = side_b ? pair.leaves.end_b : pair.leaves.end_a;
    for (std::uint32_t t = begin; t < end; ++t) {
      for (const std::uint32_t vertex : owner.view.arrays.triangles[t]) marked_[vertex] = 1;
    }
  }
  for (std::uint32_t vertex = 0; vertex < marked_.size(); ++vertex) {
    if (marked_[vertex] != 0) vertices_.push_back(vertex);
  }
}

}  // namespace supple
