#include "scene/proximity_pass.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include "core/float_rounding.hpp"
#include "core/timer.hpp"

namespace supple {
namespace {

constexpr std::size_t block_size = RelativeMotionBlock::capacity;

/// One of the two elements of a pair: its vertices by ascending user's ids, and its name.
struct Element {
  FeatureKind kind = FeatureKind::vertex;
  std::uint8_t count = 0;
  std::array<std::uint32_t, 3> ids{};     ///< ascending
  std::array<std::uint8_t, 3> corners{};  ///< the corner of the user's triangle that has each id
  std::array<Vec3d, 3> points{};
  std::uint32_t triangle = 0;

  std::array<std::uint32_t, 2> name() const {
    if (kind == FeatureKind::face) return {triangle, triangle};
    return {ids[0], ids[count - 1u]};
  }
  /// The larger id counts first.
  std::array<std::uint32_t, 2> edge_order() const { return {ids[1], ids[0]}; }
};

Element element_of(const MovingObject& object, std::span<const std::uint32_t> vertices) {
  Element element;
  element.count = static_cast<std::uint8_t>(vertices.size());
  element.kind = static_cast<FeatureKind>(vertices.size() - 1);
  std::array<std::uint8_t, 3> order{0, 1, 2};
  const auto id = [&](std::uint8_t i) { return object.vertex_ids[vertices[i]]; };
  for (std::size_t i = 1; i < element.count; ++i) {
    for (std::size_t j = i; j > 0 && id(order[j]) < id(order[j - 1]); --j) std::swap(order[j], order[j - 1]);
  }
  for (std::size_t i = 0; i < element.count; ++i) {
    element.ids[i] = id(order[i]);
    element.corners[i] = order[i];
    element.points[i] = placed((*object.end)[vertices[order[i]]], object);
  }
  return element;
}

/// Which of an element's sorted vertices a feature has.
std::array<std::uint8_t, 2> ends_of(const Feature& feature) {
  if (feature.kind == FeatureKind::vertex) return {feature.index, feature.index};
  // Edge 2 of a triangle joins corners 2 and 0.
  if (feature.index == 2) return {0, 2};
  return {feature.index, static_cast<std::uint8_t>(feature.index + 1)};
}

/// The side of a pair that belongs to one element.
struct Side {
  FeatureKind kind;
  std::array<std::uint32_t, 2> name;
  Feature on;
  std::array<double, 3> barycentric{};
};

/// The element itself, in the numbering of the user's triangle.
Side side_of_element(const Element& element, const Feature& on, const std::array<double, 3>& barycentric) {
  Side side{element.kind, element.name(), on};
  for (std::size_t i = 0; i < element.count; ++i) side.barycentric[element.corners[i]] = barycentric[i];
  if (element.kind != FeatureKind::face) {
    side.barycentric = barycentric;
  } else if (on.kind == FeatureKind::vertex) {
    side.on.index = element.corners[on.index];
  } else if (on.kind == FeatureKind::edge) {
    const auto [first, last] = ends_of(on);
    const auto [low, high] = std::minmax(element.corners[first], element.corners[last]);
    side.on.index = high - low == 2 ? std::uint8_t{2} : low;
  }
  return side;
}

/// The smallest feature as an element of its own.
Side side_of_feature(const Element& element, const Feature& on, const std::array<double, 3>& barycentric) {
  if (on.kind == FeatureKind::face || element.count == 1) return side_of_element(element, on, barycentric);
  const auto [first, last] = ends_of(on);
  Side side{on.kind, {element.ids[first], element.ids[last]}, {on.kind, 0}};
  side.barycentric = on.kind == FeatureKind::vertex ? std::array<double, 3>{1, 0, 0}
                                                    : std::array{barycentric[first], barycentric[last], 0.0};
  return side;
}

/// The points of both elements in the order of `ElementPoints`: element a has the fewer vertices.
ElementPoints points_of(const Element& a, const Element& b) {
  ElementPoints elements;
  elements.count_a = a.count;
  elements.count_b = b.count;
  std::copy_n(a.points.begin(), a.count, elements.points.begin());
  std::copy_n(b.points.begin(), b.count, elements.points.begin() + a.count);
  return elements;
}

/// The element with the corners in the user's order.
Element in_corner_order(const Element& element) {
  Element result = element;
  for (std::size_t i = 0; i < element.count; ++i) {
    const std::size_t to = element.kind == FeatureKind::face ? element.corners[i] : i;
    result.points[to] = element.points[i];
  }
  return result;
}

/// A feature as an element.
Element feature_of(const Element& element, const Feature& on) {
  if (on.kind == FeatureKind::face || element.count == 1) return in_corner_order(element);
  const auto [first, last] = ends_of(on);
  Element feature;
  feature.kind = on.kind;
  feature.count = on.kind == FeatureKind::vertex ? 1 : 2;
  feature.points = {element.points[first], element.points[last]};
  return feature;
}

/// The direction across two elements or features that touch, towards a.
Vec3d normal_across(const Element& a, const Element& b) {
  bool used_exact = false;
  if (a.count <= b.count) return distance_within(points_of(a, b), any_distance, used_exact)->normal;
  return -1.0 * distance_within(points_of(b, a), any_distance, used_exact)->normal;
}

void swap_sides(ProximityPair& pair) {
  std::swap(pair.kind_a, pair.kind_b);
  std::swap(pair.element_a, pair.element_b);
  std::swap(pair.on_a, pair.on_b);
  std::swap(pair.barycentric_a, pair.barycentric_b);
  std::swap(pair.point_a, pair.point_b);
  pair.normal = -1.0 * pair.normal;
}

}  // namespace

bool ProximityPass::run(std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
                        std::span<const std::uint64_t> versions, ProximityListing listing,
                        std::uint64_t max_pairs, const StopSignal& stop, const Parallel& parallel,
                        StepStats& stats) {
  Timer timer;
  jobs_ = jobs;
  objects_ = objects;
  stop_ = stop;
  listing_ = listing;
  outcomes_.plan(jobs, versions, listing == last_listing_);
  last_listing_ = listing;
  workers_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.traversal.set_stop(stop);
    worker.found.clear();
    worker.stats = {};
  }
  tasks_.plan(outcomes_.open_jobs(), workers_.size(), workers_[0].traversal,
              [&](std::uint32_t job) { return view_of_job(job); });
  outcomes_.expect_tasks(tasks_.tasks().size());
  tasks_.run(parallel, workers_, stop, [&](std::size_t task, std::uint32_t w) { run_task(task, w); });
  add_stats(workers_, timer.lap(), stats);
  if (stop.stop_requested()) return false;
  sort_found(parallel);
  outcomes_.place(tasks_.tasks());
  outcomes_.move_known<0>(pairs_);
  for (std::size_t open = 0; open < outcomes_.open_jobs().size(); ++open) {
    ProximityPair* to = pairs_.data() + outcomes_.ranges(outcomes_.open_jobs()[open])[0].first;
    for (const Key& key : keys_[open]) *to++ = workers_[key.worker].found[key.index];
  }
  outcomes_.complete();
  is_truncated_ = pairs_.size() > max_pairs;
  if (is_truncated_) {
    outcomes_.truncate(max_pairs);
    pairs_.resize(static_cast<std::size_t>(max_pairs));
  }
  outcomes_.list_groups(groups_, [&](std::uint32_t object) { return objects_[object].id; });
  stats.proximity_pairs += pairs_.size();
  stats.sort_and_events_seconds += timer.lap();
  return true;
}

ObjectPairView ProximityPass::view_of_job(std::uint32_t job) const {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const double reach = reach_of_margins(a.margin, b.margin);
  return &a == &b ? moving_self_pair_of(a.view, reach) : moving_pair_of(a.view, b.view, reach);
}

void ProximityPass::run_task(std::size_t task, std::uint32_t w) {
  const auto [job, root] = tasks_.tasks()[task];
  Worker& worker = workers_[w];
  const std::size_t first = worker.found.size();
  worker.traversal.find_element_pairs(view_of_job(job), root, worker.stats.traversal,
                                      [&](ElementPairKind kind, std::span<const ElementPair> candidates) {
                                        Timer timer;
                                        test_candidates(job, kind, candidates, worker);
                                        worker.stats.exact_seconds += timer.lap();
                                      });
  const auto count = static_cast<std::uint32_t>(worker.found.size() - first);
  outcomes_.of_task(task) = {w, {{{static_cast<std::uint32_t>(first), count}}}};
}

void ProximityPass::test_candidates(std::uint32_t job, ElementPairKind kind,
                                    std::span<const ElementPair> candidates, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const auto objects = objects_of(kind, a, b);
  const bool are_edges = kind == ElementPairKind::edge_edge;
  const float reach = round_up(reach_of_margins(a.margin, b.margin));
  std::array<std::array<std::uint32_t, 4>, block_size> vertices;
  for (; !candidates.empty() && !stop_.stop_requested();
       candidates = candidates.subspan(std::min(block_size, candidates.size()))) {
    const auto part = candidates.first(std::min(block_size, candidates.size()));
    for (std::size_t k = 0; k < part.size(); ++k) vertices[k] = vertices_of(kind, part[k], a, b);
    fill(objects, std::span(vertices).first(part.size()), are_edges, 1, worker.block);
    for (std::uint64_t left = may_touch(worker.block, part.size(), are_edges, reach); left != 0;
         left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      add_pair(job, kind, part[k], vertices[k], worker);
    }
  }
}

/// Adds the pair if it is within reach. All numbers depend on the user's ids and the positions alone, not on
/// the octrees: two element pairs with the same closest features give the same bits.
void ProximityPass::add_pair(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                             std::array<std::uint32_t, 4> vertices, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const bool are_edges = kind == ElementPairKind::edge_edge, is_self = &a == &b;
  const auto objects = objects_of(kind, a, b);
  const std::size_t count = are_edges ? 2 : 1;
  // A vertex stands before a face here.
  Element first = element_of(*objects[0], std::span(vertices).first(count));
  Element second = element_of(*objects[3], std::span(vertices).subspan(count));
  if (kind == ElementPairKind::vertex_face) second.triangle = b.triangle_ids[candidate.b];
  if (kind == ElementPairKind::face_vertex) second.triangle = a.triangle_ids[candidate.a];
  if (is_self && are_edges && second.edge_order() < first.edge_order()) std::swap(first, second);
  bool used_exact = false;
  const auto found =
      distance_within(points_of(first, second), reach_of_margins(a.margin, b.margin), used_exact);
  worker.stats.exact_fallbacks += used_exact ? 1 : 0;
  if (!found) return;
  const bool lists_features = listing_ == ProximityListing::features;
  const auto side_of = lists_features ? side_of_feature : side_of_element;
  const Side side_a = side_of(first, found->on_a, found->barycentric_a),
             side_b = side_of(second, found->on_b, found->barycentric_b);
  ProximityPair pair{
      a.id,           b.id,         side_a.kind,     side_b.kind,        side_a.name,        side_b.name,
      side_a.on,      side_b.on,    found->distance, side_a.barycentric, side_b.barycentric, found->point_a,
      found->point_b, found->normal};
  const bool swaps = is_self ? std::tie(side_b.kind, side_b.name) < std::tie(side_a.kind, side_a.name)
                             : kind == ElementPairKind::face_vertex;
  if (swaps) swap_sides(pair);
  if (pair.distance == 0) {
    // The direction across features that touch must not depend on the elements around them.
    const Element of_first = lists_features ? feature_of(first, found->on_a) : in_corner_order(first);
    const Element of_second = lists_features ? feature_of(second, found->on_b) : in_corner_order(second);
    pair.normal = swaps ? normal_across(of_second, of_first) : normal_across(of_first, of_second);
  }
  pair.normal = pair.normal + Vec3d{};  // no negative zeros, which depend on the order of the elements
  worker.found.push_back(pair);
}

/// Orders the pairs of each open job, each once, and tells their number to the outcomes.
void ProximityPass::sort_found(const Parallel& parallel) {
  first_tasks_.clear();
  for (std::uint32_t task = 0; task < tasks_.tasks().size(); ++task) {
    if (task == 0 || tasks_.tasks()[task].job != tasks_.tasks()[task - 1].job) first_tasks_.push_back(task);
  }
  const std::size_t jobs = first_tasks_.size();
  first_tasks_.push_back(static_cast<std::uint32_t>(tasks_.tasks().size()));
  if (keys_.size() < outcomes_.open_jobs().size()) keys_.resize(outcomes_.open_jobs().size());
  for (std::vector<Key>& keys : keys_) keys.clear();
  parallel.for_ranges(jobs, 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& open = outcomes_.open_jobs();
      const auto place = std::lower_bound(open.begin(), open.end(), tasks_.tasks()[first_tasks_[i]].job);
      sort_job(first_tasks_[i], first_tasks_[i + 1], keys_[static_cast<std::size_t>(place - open.begin())]);
    }
  });
}

void ProximityPass::sort_job(std::size_t first_task, std::size_t end_task, std::vector<Key>& keys) {
  for (std::size_t task = first_task; task < end_task; ++task) {
    auto& [w, ranges] = outcomes_.of_task(task);
    for (std::uint32_t i = ranges[0].first; i < ranges[0].end(); ++i) {
      const ProximityPair& pair = workers_[w].found[i];
      keys.push_back({pair.kind_a, pair.kind_b, pair.element_a, pair.element_b, w, i});
    }
    ranges[0].count = 0;
  }
  std::sort(keys.begin(), keys.end());
  const auto same = [](const Key& p, const Key& q) { return p.is_same_pair(q); };
  keys.erase(std::unique(keys.begin(), keys.end(), same), keys.end());
  outcomes_.of_task(first_task).ranges[0].count = static_cast<std::uint32_t>(keys.size());
}

}  // namespace supple
