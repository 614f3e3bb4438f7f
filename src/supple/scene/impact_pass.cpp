#include "scene/impact_pass.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <type_traits>
#include <utility>

#include "contact/first_impact.hpp"
#include "contact/impact_search.hpp"
#include "core/float_rounding.hpp"
#include "core/timer.hpp"

namespace supple {
namespace {

constexpr std::size_t block_size = RelativeMotionBlock::capacity;

/// A vertex, in octree order, of one of the objects at hand.
struct VertexRef {
  const MovingObject* object;
  std::uint32_t vertex;
};

/// The four vertices of a pair of elements in the order in which motions have them.
std::array<VertexRef, 4> vertices_of(ElementPairKind kind, ElementPair pair, const MovingObject& a,
                                     const MovingObject& b) {
  switch (kind) {
    case ElementPairKind::vertex_face: {
      const Triangle& face = b.view.moving.face_ids[pair.b];
      return {{{&a, pair.a}, {&b, face[0]}, {&b, face[1]}, {&b, face[2]}}};
    }
    case ElementPairKind::face_vertex: {
      const Triangle& face = a.view.moving.face_ids[pair.a];
      return {{{&b, pair.b}, {&a, face[0]}, {&a, face[1]}, {&a, face[2]}}};
    }
    default: {
      const Edge& first = a.view.moving.edge_ids[pair.a];
      const Edge& second = b.view.moving.edge_ids[pair.b];
      return {{{&a, first[0]}, {&a, first[1]}, {&b, second[0]}, {&b, second[1]}}};
    }
  }
}

template <class Motion>
Motion motion_of(const std::array<VertexRef, 4>& vertices) {
  Motion motion;
  for (std::size_t i = 0; i < 4; ++i) {
    motion.start[i] = (*vertices[i].object->start)[vertices[i].vertex];
    motion.end[i] = (*vertices[i].object->end)[vertices[i].vertex];
  }
  return motion;
}

std::uint32_t user_vertex(const VertexRef& ref) {
  return ref.object->vertex_ids[ref.vertex];
}

/// Edges by their smaller vertex, and of one object with itself the smaller edge first, in the user's
/// numbers: so that nothing in a contact depends on the octrees' shape.
void sort_edges(std::array<VertexRef, 4>& vertices) {
  for (const std::size_t i : {0u, 2u}) {
    if (user_vertex(vertices[i + 1]) < user_vertex(vertices[i])) std::swap(vertices[i], vertices[i + 1]);
  }
  if (vertices[0].object != vertices[2].object) return;
  if (std::pair(user_vertex(vertices[2]), user_vertex(vertices[3])) <
      std::pair(user_vertex(vertices[0]), user_vertex(vertices[1]))) {
    std::swap(vertices[0], vertices[2]);
    std::swap(vertices[1], vertices[3]);
  }
}

/// Positions of an object in octree order at both ends of the step.
template <class Scalar>
struct Path {
  VertexArray<Scalar> start, end;

  explicit Path(const MovingObject& object) {
    if constexpr (std::is_same_v<Scalar, float>) {
      start = object.start->floats(), end = object.end->floats();
    } else {
      start = object.start->doubles(), end = object.end->doubles();
    }
  }
};

template <class Scalar>
Vec3<Scalar> vertex(const VertexArray<Scalar>& positions, std::uint32_t index) {
  const Scalar* const p = positions[index];
  return {p[0], p[1], p[2]};
}

/// Fills a block with pairs as they are until `latest`. Differences of floats are rounded to float once, all
/// others in double before.
template <class ScalarA, class ScalarB>
class BlockFill {
 public:
  BlockFill(const MovingObject& a, const MovingObject& b, float latest, RelativeMotionBlock& block)
      : a_(a), b_(b), path_a_(a), path_b_(b), latest_(latest), block_(block) {}

  void set(std::size_t k, ElementPairKind kind, ElementPair pair) {
    if (kind == ElementPairKind::vertex_face) {
      set_vertex_face(k, path_a_, pair.a, path_b_, b_.view.moving.face_ids[pair.b]);
    } else if (kind == ElementPairKind::face_vertex) {
      set_vertex_face(k, path_b_, pair.b, path_a_, a_.view.moving.face_ids[pair.a]);
    } else {
      set_edge_edge(k, a_.view.moving.edge_ids[pair.a], b_.view.moving.edge_ids[pair.b]);
    }
  }

 private:
  using Row = RelativeMotionBlock;

  template <class ScalarV, class ScalarF>
  void set_vertex_face(std::size_t k, const Path<ScalarV>& v, std::uint32_t index, const Path<ScalarF>& f,
                       const Triangle& face) {
    const Vec3<ScalarF> s0 = vertex(f.start, face[0]), e0 = vertex(f.end, face[0]);
    set(k, Row::m, difference(vertex(v.start, index), s0), difference(vertex(v.end, index), e0));
    set(k, Row::u, difference(vertex(f.start, face[1]), s0), difference(vertex(f.end, face[1]), e0));
    set(k, Row::w, difference(vertex(f.start, face[2]), s0), difference(vertex(f.end, face[2]), e0));
  }

  void set_edge_edge(std::size_t k, const Edge& p, const Edge& q) {
    const Vec3<ScalarA> sp = vertex(path_a_.start, p[0]), ep = vertex(path_a_.end, p[0]);
    const Vec3<ScalarB> sq = vertex(path_b_.start, q[0]), eq = vertex(path_b_.end, q[0]);
    set(k, Row::m, difference(sp, sq), difference(ep, eq));
    set(k, Row::u, difference(sp, vertex(path_a_.start, p[1])), difference(ep, vertex(path_a_.end, p[1])));
    set(k, Row::w, difference(vertex(path_b_.start, q[1]), sq), difference(vertex(path_b_.end, q[1]), eq));
  }

  template <class P, class Q>
  static auto difference(const Vec3<P>& p, const Vec3<Q>& q) {
    using Scalar = std::common_type_t<P, Q>;
    return Vec3<Scalar>{Scalar{p.x} - Scalar{q.x}, Scalar{p.y} - Scalar{q.y}, Scalar{p.z} - Scalar{q.z}};
  }

  template <class Scalar>
  void set(std::size_t k, std::size_t row, const Vec3<Scalar>& start, const Vec3<Scalar>& end) {
    for (int axis = 0; axis < 3; ++axis) {
      float* const rows = block_.rows[row + static_cast<std::size_t>(axis)] + k;
      rows[0] = static_cast<float>(start[axis]);
      rows[Row::end * Row::capacity] =
          latest_ < 1 ? static_cast<float>((1 - double{latest_}) * start[axis] + double{latest_} * end[axis])
                      : static_cast<float>(end[axis]);
    }
  }

  const MovingObject& a_;
  const MovingObject& b_;
  Path<ScalarA> path_a_;
  Path<ScalarB> path_b_;
  float latest_;
  RelativeMotionBlock& block_;
};

template <class ScalarA, class ScalarB>
void fill(const MovingObject& a, const MovingObject& b, float latest, ElementPairKind kind,
          std::span<const ElementPair> candidates, RelativeMotionBlock& block) {
  BlockFill<ScalarA, ScalarB> filled(a, b, latest, block);
  for (std::size_t k = 0; k < candidates.size(); ++k) filled.set(k, kind, candidates[k]);
}

/// What the impact says of the elements of a and b.
void set_impact(ContinuousContact& contact, const Impact& impact) {
  const auto& w = impact.barycentric;
  contact.certainty = impact.certainty;
  contact.toi = impact.toi;
  contact.point = impact.point;
  contact.normal = impact.normal;
  switch (contact.kind) {
    case ElementPairKind::vertex_face:
      contact.barycentric_a = {1, 0, 0};
      contact.barycentric_b = {w[1], w[2], w[3]};
      break;
    case ElementPairKind::face_vertex:
      contact.barycentric_a = {w[1], w[2], w[3]};
      contact.barycentric_b = {1, 0, 0};
      contact.normal = -1.0 * impact.normal;
      break;
    case ElementPairKind::edge_edge:
      contact.barycentric_a = {w[0], w[1], 0};
      contact.barycentric_b = {w[2], w[3], 0};
      break;
  }
}

}  // namespace

void ImpactPass::run(std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
                     const ImpactOptions& options, const Parallel& parallel, StepStats& stats) {
  Timer timer;
  search(Search::all, jobs, objects, options, parallel);
  add_stats(workers_, timer.lap(), stats);
  gather_contacts();
  stats.contacts = contacts_.size();
  stats.sort_and_events_seconds += timer.lap();
}

std::optional<ContinuousContact> ImpactPass::find_earliest(std::span<const ContactJob> jobs,
                                                           std::span<const MovingObject> objects,
                                                           const ImpactOptions& options,
                                                           const Parallel& parallel) {
  search(Search::earliest, jobs, objects, options, parallel);
  const Worker* best = nullptr;
  for (const Worker& worker : workers_) {
    if (!worker.earliest) continue;
    if (best == nullptr || std::tie(worker.earliest->toi, worker.earliest_key) <
                               std::tie(best->earliest->toi, best->earliest_key)) {
      best = &worker;
    }
  }
  return best != nullptr ? best->earliest : std::nullopt;
}

void ImpactPass::search(Search search, std::span<const ContactJob> jobs,
                        std::span<const MovingObject> objects, const ImpactOptions& options,
                        const Parallel& parallel) {
  search_ = search;
  jobs_ = jobs;
  objects_ = objects;
  options_ = options;
  parallel_ = &parallel;
  latest_ = 1;
  workers_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.found.clear();
    worker.keys.clear();
    worker.stats = {};
    worker.earliest.reset();
  }
  tasks_.plan(static_cast<std::uint32_t>(jobs.size()), workers_.size(), workers_[0].traversal,
              [&](std::uint32_t job) { return view_of_job(job); });
  tasks_.run(parallel, workers_, [&](const ContactTask& task, Worker& worker) { run_task(task, worker); });
}

ObjectPairView ImpactPass::view_of_job(std::uint32_t job) const {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  ObjectPairView pair = &a == &b ? moving_self_pair_of(a.view, options_.min_separation)
                                 : moving_pair_of(a.view, b.view, options_.min_separation);
  if (search_ == Search::earliest) pair.latest = &latest_;
  return pair;
}

void ImpactPass::run_task(const ContactTask& task, Worker& worker) {
  worker.traversal.find_element_pairs(
      view_of_job(task.job), task.root, worker.stats.traversal,
      [&](ElementPairKind kind, std::span<const ElementPair> candidates) {
        Timer timer;
        for (std::size_t first = 0; first < candidates.size(); first += block_size) {
          const std::size_t count = std::min(block_size, candidates.size() - first);
          test_candidates(task.job, kind, candidates.subspan(first, count), worker);
        }
        worker.stats.exact_seconds += timer.lap();
      });
}

/// Most candidates are far from touching: that is decided for a block at a time, in vector lanes.
void ImpactPass::test_candidates(std::uint32_t job, ElementPairKind kind,
                                 std::span<const ElementPair> candidates, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const float latest = latest_.load(std::memory_order_relaxed);
  const auto fill_block = a.end->is_double() ? b.end->is_double() ? fill<double, double> : fill<double, float>
                          : b.end->is_double() ? fill<float, double>
                                               : fill<float, float>;
  fill_block(a, b, latest, kind, candidates, worker.block);
  std::uint64_t left = may_touch(worker.block, candidates.size(), kind == ElementPairKind::edge_edge,
                                 round_up(options_.min_separation));
  for (; left != 0; left &= left - 1) {
    test_candidate(job, kind, candidates[static_cast<std::size_t>(std::countr_zero(left))], worker);
  }
}

void ImpactPass::test_candidate(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                                Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  auto vertices = vertices_of(kind, candidate, a, b);
  bool used_exact = false;
  const auto first_impact_of = [&]<class Motion>(std::type_identity<Motion>) {
    const Motion motion = motion_of<Motion>(vertices);
    return first_impact_of_finite(motion, relative_motion(motion), options_, used_exact);
  };
  ContinuousContact contact;
  contact.object_a = a.id;
  contact.object_b = b.id;
  contact.kind = kind;
  std::optional<Impact> impact;
  if (kind == ElementPairKind::edge_edge) {
    sort_edges(vertices);
    impact = first_impact_of(std::type_identity<EdgeEdgeMotion>());
    contact.element_a = {user_vertex(vertices[0]), user_vertex(vertices[1])};
    contact.element_b = {user_vertex(vertices[2]), user_vertex(vertices[3])};
  } else {
    impact = first_impact_of(std::type_identity<VertexFaceMotion>());
    const bool vertex_first = kind == ElementPairKind::vertex_face;
    const std::uint32_t of_a = vertex_first ? a.vertex_ids[candidate.a] : a.triangle_ids[candidate.a];
    const std::uint32_t of_b = vertex_first ? b.triangle_ids[candidate.b] : b.vertex_ids[candidate.b];
    contact.element_a = {of_a, of_a};
    contact.element_b = {of_b, of_b};
  }
  worker.stats.exact_fallbacks += used_exact ? 1 : 0;
  if (!impact) return;
  set_impact(contact, *impact);
  keep({job, kind, contact.element_a, contact.element_b}, contact, worker);
}

void ImpactPass::keep(Key key, const ContinuousContact& contact, Worker& worker) {
  if (search_ == Search::all) {
    key.worker = static_cast<std::uint32_t>(&worker - workers_.data());
    key.index = static_cast<std::uint32_t>(worker.found.size());
    worker.keys.push_back(key);
    worker.found.push_back(contact);
    return;
  }
  if (worker.earliest && std::tie(worker.earliest->toi, worker.earliest_key) < std::tie(contact.toi, key)) {
    return;
  }
  worker.earliest = contact;
  worker.earliest_key = key;
  // Reported times may be early by the tolerance, so that the first of them can be of a pair that touches
  // after the first touch.
  const float until = round_up(contact.toi + toi_tolerance);
  float latest = latest_.load(std::memory_order_relaxed);
  while (until < latest && !latest_.compare_exchange_weak(latest, until, std::memory_order_relaxed)) {
  }
}

/// Sorts each worker's keys and merges them pair by pair, in parallel, into those of the first.
void ImpactPass::merge_keys() {
  parallel_->for_ranges(workers_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t w = begin; w < end; ++w) std::sort(workers_[w].keys.begin(), workers_[w].keys.end());
  });
  for (std::size_t step = 1; step < workers_.size(); step *= 2) {
    const std::size_t merges = (workers_.size() - step + 2 * step - 1) / (2 * step);
    parallel_->for_ranges(merges, 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t i = begin; i < end; ++i) {
        Worker& first = workers_[2 * step * i];
        const Worker& second = workers_[2 * step * i + step];
        first.merged_keys.resize(first.keys.size() + second.keys.size());
        std::merge(first.keys.begin(), first.keys.end(), second.keys.begin(), second.keys.end(),
                   first.merged_keys.begin());
        first.keys.swap(first.merged_keys);
      }
    });
  }
}

void ImpactPass::gather_contacts() {
  merge_keys();
  const std::vector<Key>& keys = workers_.front().keys;
  contacts_.resize(keys.size());
  parallel_->for_ranges(keys.size(), 4096, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) contacts_[i] = workers_[keys[i].worker].found[keys[i].index];
  });
  groups_.clear();
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i].job != keys[i - 1].job)
      groups_.push_back({contacts_[i].object_a, contacts_[i].object_b, i, 0});
    ++groups_.back().contact_count;
  }
}

}  // namespace supple
