#include "answers/proximity/proximity_pass.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <span>
#include <utility>

#include "contact/distance/edge_face_crossing.hpp"
#include "core/sort_once.hpp"
#include "core/timer.hpp"

namespace supple {
namespace {

constexpr std::size_t block_size = PointsBlock::capacity;
constexpr std::size_t least_merge = 65536;  // candidates, 2 MB; fewer with a limit
// The codes of a vertex and a point or an edge, which have the vertices of a face with equal corners.
constexpr auto first_vertices = static_cast<FeatureCode>(1), first_edge = static_cast<FeatureCode>(4);

template <std::size_t count>
ElementIds element_of(const MovingObject& object, std::span<const std::uint32_t, count> vertices,
                      std::uint32_t triangle) {
  std::array<std::uint32_t, count> ids;
  for (std::size_t i = 0; i < count; ++i) ids[i] = object.vertex_ids[vertices[i]];
  return ElementIds(ids, triangle);
}

PairElement with_points_of(const MovingObject& object, const ElementIds& element,
                           const std::uint32_t* vertices) {
  PairElement result(element);
  for (std::size_t i = 0; i < element.count; ++i)
    result.points[i] = placed((*object.end)[vertices[element.corners[i]]], object);
  return result;
}

/// Sets one vertex of each pair.
template <std::size_t size>
void set_points(const MovingObject& object, std::span<const std::array<std::uint32_t, size>> vertices,
                std::size_t vertex, PointsBlock& block) {
  const auto set = [&, moved = object.view.translation](const auto& positions) {
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const auto* const p = positions[vertices[k][vertex]];
      block.set(vertex, k, Vec3d{p[0], p[1], p[2]} + moved);
    }
  };
  if (!object.end->is_double()) return set(object.end->floats());
  const VertexArray<double> positions = object.end->doubles();
  if (object.view.translation != Vec3d{}) return set(positions);
  // Four scalars from each vertex on are readable.
  for (std::size_t k = 0; k < vertices.size(); ++k)
    std::memcpy(block.points[vertex][k], positions[vertices[k][vertex]], sizeof block.points[vertex][k]);
}

std::array<std::uint32_t, 2> in_order(std::uint32_t p, std::uint32_t q) {
  return {std::min(p, q), std::max(p, q)};
}

/// Renumbers the vertices of features: vertex i becomes `places[i]`.
ClosestFeatures renumbered(ClosestFeatures features, const std::array<std::uint8_t, 4>& places) {
  using Kind = ClosestFeatures::Kind;
  if (features.kind == Kind::interiors) return features;
  features.vertex = places[features.vertex];
  features.edge[0] = places[features.edge[0]];
  if (features.kind == Kind::vertices) {
    if (features.vertex > features.edge[0]) std::swap(features.vertex, features.edge[0]);
    return features;
  }
  features.edge[1] = places[features.edge[1]];
  if (features.edge[0] > features.edge[1]) std::swap(features.edge[0], features.edge[1]);
  return features;
}

}  // namespace

void ProximityWorker::start() {
  runs.clear();
  run_first = 0;
  merge_at = 0;
  is_full = false;
  decisions.clear();
}

bool ProximityPass::run(const PassInput& input, std::span<const MovingObject> objects,
                        const ProximitySearch& search, StepStats& stats) {
  begin(input.jobs, objects, input.stop);
  const bool is_same_search = std::exchange(search_, search) == search;
  max_pairs_ = input.max_contacts;
  constexpr std::uint64_t few = 1024;
  least_merge_ = max_pairs_ < least_merge / 4 ? static_cast<std::size_t>(2 * max_pairs_ + few) : least_merge;
  // Two workers may find the same pair, so `limit_` cannot count them; each worker has its own limit.
  if (!run_open_jobs(input, is_same_search, ContactLimit::unlimited, stats)) return false;
  for (Worker& worker : workers_) worker.stats = {};
  Timer timer;
  sort_found(input.parallel);
  outcomes_.place();
  outcomes_.move_known<0>(records_);
  stats.sort_and_events_seconds += timer.lap();
  compute_found(input.parallel);
  for (const Worker& worker : workers_) stats.exact_fallbacks += worker.stats.exact_fallbacks;
  stats.exact_seconds += timer.lap();
  outcomes_.complete();
  end(max_pairs_);
  stats.proximity_pairs += records_.size();
  stats.sort_and_events_seconds += timer.lap();
  return true;
}

ObjectPairView ProximityPass::view_of_job(std::uint32_t job) const {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  ObjectPairView pair = pair_of(a.view, b.view, reach_of_margins(a.margin, b.margin));
  pair.kinds = search_.kinds;
  pair.with_crossings = search_.kinds == ElementKinds::all;
  return pair;
}

void ProximityPass::run_task(std::size_t task, Worker& worker) {
  const std::uint32_t job = tasks_[task].job;
  if (worker.is_full && worker.last.job < job) return;
  worker.traversal.find_element_pairs(
      view_of_job(job), tasks_[task].root, worker.stats.traversal,
      [&](ElementPairKind kind, std::span<const ElementPair> candidates) {
        Timer timer;
        test_candidates(job, kind, candidates, worker);
        worker.stats.exact_seconds += timer.lap();
      },
      [&](bool edge_is_of_a, std::span<const ElementPair> candidates) {
        Timer timer;
        test_crossings(job, edge_is_of_a ? CandidateKind::edge_face : CandidateKind::face_edge, candidates,
                       worker);
        worker.stats.exact_seconds += timer.lap();
      });
  const auto end = static_cast<std::uint32_t>(worker.found.size());
  if (worker.run_first < end) worker.runs.push_back({job, worker.run_first, end});
  worker.run_first = end;
}

void ProximityPass::test_candidates(std::uint32_t job, ElementPairKind kind,
                                    std::span<const ElementPair> candidates, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const auto objects = objects_of(kind, a, b);
  const bool are_edges = kind == ElementPairKind::edge_edge;
  const double reach = reach_of_margins(a.margin, b.margin);
  std::array<std::array<std::uint32_t, 4>, block_size> vertices;
  std::array<FeatureCode, block_size> codes;
  for (; !candidates.empty() && !stop_.stop_requested();
       candidates = candidates.subspan(std::min(block_size, candidates.size()))) {
    const auto part = candidates.first(std::min(block_size, candidates.size()));
    for (std::size_t k = 0; k < part.size(); ++k) vertices[k] = vertices_of(kind, part[k], a, b);
    for (std::size_t i = 0; i < 4; ++i)
      set_points<4>(*objects[i], std::span(vertices).first(part.size()), i, worker.block);
    classify(worker.block, part.size(), are_edges, reach, codes.data());
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (codes[k] == FeatureCode::apart || !may_touch_by_groups(objects, vertices[k], are_edges)) continue;
      add(job, kind, part[k], vertices[k], codes[k], worker);
    }
  }
}

void ProximityPass::add(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                        const std::array<std::uint32_t, 4>& vertices, FeatureCode code, Worker& worker) {
  const MovingObject &a = objects_[jobs_[job].a], &b = objects_[jobs_[job].b];
  const bool are_edges = kind == ElementPairKind::edge_edge,
             is_swapped = kind == ElementPairKind::face_vertex;
  const MovingObject &first = is_swapped ? b : a, &last = is_swapped ? a : b;
  const std::uint32_t triangle = are_edges ? 0 : last.triangle_ids[is_swapped ? candidate.a : candidate.b];
  const bool is_extra = !are_edges && triangle >= last.face_count;  // an edge or a point of no triangle
  if (code == FeatureCode::unknown || is_extra) code = decide(job, kind, candidate, worker);
  if (code == FeatureCode::apart) return;
  FeatureCode listed = code;
  if (search_.listing == ProximityListing::elements)
    listed = !is_extra ? FeatureCode::interiors : vertices[1] == vertices[2] ? first_vertices : first_edge;
  const auto [p, p_end, q, q_end] = ends_of_code(listed, are_edges);
  PairName name{static_cast<FeatureKind>(p != p_end), static_cast<FeatureKind>(q != q_end),
                in_order(first.vertex_ids[vertices[p]], first.vertex_ids[vertices[p_end]]),
                in_order(last.vertex_ids[vertices[q]], last.vertex_ids[vertices[q_end]])};
  if (!are_edges && listed == FeatureCode::interiors) {
    name.kind_b = FeatureKind::face;
    name.element_b = {triangle, triangle};
  }
  const auto candidate_kind = static_cast<CandidateKind>(kind);
  name.put_in_order(order_of(job, candidate_kind));
  keep({job, name, candidate_kind, code, candidate}, worker);
}

/// What only exact arithmetic decides.
FeatureCode ProximityPass::decide(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                                  Worker& worker) const {
  const Elements elements = elements_of(job, kind, candidate);
  const auto [first, second] = with_points(job, kind, elements);
  const ElementPoints points = points_of(first, second);
  if (std::exchange(worker.job_of_decisions, job) != job) worker.decisions.clear();
  ProximityWorker::Decision decision;
  if (const auto* const known = worker.decisions.find(points)) {
    decision = *known;
  } else {
    const double reach = reach_of_margins(objects_[jobs_[job].a].margin, objects_[jobs_[job].b].margin);
    decision.features = closest_features_within(points, reach, decision.used_exact);
    worker.decisions.store(points, decision);
  }
  worker.stats.exact_fallbacks += decision.used_exact ? 1 : 0;
  if (!decision.features) return FeatureCode::apart;
  std::uint8_t code = 0;
  while (elements.features_of(static_cast<FeatureCode>(code)) != *decision.features) ++code;
  return static_cast<FeatureCode>(code);
}

/// In the numbering of `ElementPoints`.
ClosestFeatures ProximityPass::Elements::features_of(FeatureCode code) const {
  std::array<std::uint8_t, 4> places{};
  for (std::uint8_t i = 0; i < first.count; ++i) places[first.corners[i] + (is_swapped ? 2u : 0u)] = i;
  for (std::uint8_t i = 0; i < second.count; ++i)
    places[second.corners[i] + (is_swapped ? 0u : first.count)] = static_cast<std::uint8_t>(first.count + i);
  return renumbered(features_of_code(code, first.count == 2), places);
}

ProximityPass::Crossing ProximityPass::crossing_of(std::uint32_t job, CandidateKind kind,
                                                   ElementPair candidate) const {
  const MovingObject &a = objects_[jobs_[job].a], &b = objects_[jobs_[job].b];
  if (kind == CandidateKind::edge_face)
    return {a, b, a.view.moving.edge_ids[candidate.a], b.view.moving.face_ids[candidate.b],
            b.triangle_ids[candidate.b]};
  return {b, a, b.view.moving.edge_ids[candidate.b], a.view.moving.face_ids[candidate.a],
          a.triangle_ids[candidate.a]};
}

void ProximityPass::test_crossings(std::uint32_t job, CandidateKind kind,
                                   std::span<const ElementPair> candidates, Worker& worker) {
  std::array<std::array<std::uint32_t, 5>, block_size> vertices;
  std::array<FeatureCode, block_size> codes;
  for (; !candidates.empty() && !stop_.stop_requested();
       candidates = candidates.subspan(std::min(block_size, candidates.size()))) {
    const auto part = candidates.first(std::min(block_size, candidates.size()));
    for (std::size_t k = 0; k < part.size(); ++k) {
      const auto [of_edge, of_face, edge, face, triangle] = crossing_of(job, kind, part[k]);
      vertices[k] = {edge[0], edge[1], face[0], face[1], face[2]};
    }
    const Crossing any = crossing_of(job, kind, part[0]);
    for (std::size_t i = 0; i < 5; ++i)
      set_points<5>(i < 2 ? any.of_edge : any.of_face, std::span(vertices).first(part.size()), i,
                    worker.block);
    classify_crossings(worker.block, part.size(), codes.data());
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (codes[k] == FeatureCode::apart) continue;
      const Crossing crossing = crossing_of(job, kind, part[k]);
      const auto& [of_edge, of_face, edge, face, triangle] = crossing;
      if (triangle >= of_face.face_count) continue;  // an edge or a point of no triangle
      const auto [first, second] = with_points(crossing);
      bool used_exact = false;
      const bool crosses =
          codes[k] == FeatureCode::crosses ||
          edge_crosses_face({first.points[0], first.points[1]}, corners_of(second), used_exact);
      worker.stats.exact_fallbacks += used_exact ? 1 : 0;
      if (!crosses ||
          !may_touch_by_groups(of_edge.groups, std::span(first.ids).first(2), of_face.groups, second.ids))
        continue;
      PairName name{first.kind, second.kind, first.name(), second.name()};
      name.put_in_order(order_of(job, kind));
      keep({job, name, kind, codes[k], part[k]}, worker);
    }
  }
}

/// Adds the candidate, unless it is one of the recent ones again or comes after all pairs of the result.
void ProximityPass::keep(const FoundPair& pair, Worker& worker) const {
  if (worker.is_full && worker.last < pair) return;
  std::vector<FoundPair>& found = worker.found;
  const std::uint32_t hash = pair.hash();
  auto& [of_recent, recent] = worker.recent[hash % worker.recent.size()];
  if (of_recent == hash && recent < found.size() && found[recent] == pair) return;
  of_recent = hash;
  recent = static_cast<std::uint32_t>(found.size());
  found.push_back(pair);
  if (found.size() >= std::max(worker.merge_at, least_merge_)) merge(worker);
}

/// Keeps one candidate of each name, of the first `max_pairs_` names and one more, which shows that there are
/// more.
void ProximityPass::merge(Worker& worker) const {
  std::vector<FoundPair>& found = worker.found;
  sort_once(found);
  if (found.size() > max_pairs_) {
    found.resize(static_cast<std::size_t>(max_pairs_) + 1);
    worker.is_full = true;
    worker.last = found.back();
  }
  worker.runs.clear();
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    if (i == 0 || found[i].job != found[i - 1].job) worker.runs.push_back({found[i].job, i, i});
    worker.runs.back().end = i + 1;
  }
  worker.run_first = static_cast<std::uint32_t>(found.size());
  worker.merge_at = 8 * found.size();  // few are found again
}

PairOrder ProximityPass::order_of(std::uint32_t job, CandidateKind kind) const {
  if (jobs_[job].a == jobs_[job].b) return PairOrder::by_names;
  const bool is_swapped = kind == CandidateKind::face_vertex || kind == CandidateKind::face_edge;
  return is_swapped ? PairOrder::swapped : PairOrder::given;
}

ProximityPass::Elements ProximityPass::elements_of(std::uint32_t job, ElementPairKind kind,
                                                   ElementPair candidate) const {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const auto objects = objects_of(kind, a, b);
  auto vertices = vertices_of(kind, candidate, a, b);
  const std::span<const std::uint32_t, 4> of_pair(vertices);
  if (kind == ElementPairKind::edge_edge) {
    const auto larger_first = [&](const MovingObject& object, std::size_t i) {
      const auto [low, high] =
          std::minmax({object.vertex_ids[vertices[i]], object.vertex_ids[vertices[i + 1]]});
      return std::uint64_t{high} << 32 | low;
    };
    const bool is_swapped = &a == &b && larger_first(b, 2) < larger_first(a, 0);
    if (is_swapped) vertices = {vertices[2], vertices[3], vertices[0], vertices[1]};
    return {element_of(a, of_pair.first<2>(), 0), element_of(b, of_pair.last<2>(), 0), vertices, is_swapped};
  }
  // A vertex stands before a face here.
  const std::uint32_t triangle =
      kind == ElementPairKind::vertex_face ? b.triangle_ids[candidate.b] : a.triangle_ids[candidate.a];
  const ElementIds vertex = element_of(*objects[0], of_pair.first<1>(), 0);
  const MovingObject& other = *objects[3];
  if (triangle < other.face_count)
    return {vertex, element_of(other, of_pair.last<3>(), triangle), vertices, false};
  if (vertices[1] == vertices[2])
    return {vertex, element_of(other, of_pair.subspan<1, 1>(), 0), vertices, false};
  return {vertex, element_of(other, of_pair.subspan<1, 2>(), 0), vertices, false};
}

/// Both elements with their positions.
std::array<PairElement, 2> ProximityPass::with_points(std::uint32_t job, ElementPairKind kind,
                                                      const Elements& elements) const {
  const auto objects = objects_of(kind, objects_[jobs_[job].a], objects_[jobs_[job].b]);
  const std::uint32_t* const vertices = elements.vertices.data();
  return {with_points_of(*objects[0], elements.first, vertices),
          with_points_of(*objects[3], elements.second, vertices + elements.first.count)};
}

std::array<PairElement, 2> ProximityPass::with_points(const Crossing& crossing) {
  const auto& [of_edge, of_face, edge, face, triangle] = crossing;
  return {with_points_of(of_edge, element_of(of_edge, std::span(edge), 0), edge.data()),
          with_points_of(of_face, element_of(of_face, std::span(face), triangle), face.data())};
}

/// Computes the pairs of all jobs that found some.
void ProximityPass::compute_found(const Parallel& parallel) {
  blocks_.clear();
  std::uint32_t next = 0;  // of `found_jobs_`, which are the jobs of these outcomes
  for (std::size_t outcome = 0; outcome < outcomes_.size(); ++outcome) {
    if (outcomes_.is_known(outcome)) continue;
    const auto [begin, count] = outcomes_.ranges(outcome)[0];
    for (std::uint32_t first = 0; first < count; first += block_size)
      blocks_.push_back({next, first, begin + first});
    ++next;
  }
  constexpr std::size_t grain = 8;
  parallel.for_ranges(blocks_.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    for (const auto& [i, first, place] : std::span(blocks_).subspan(begin, end - begin)) {
      const auto rest = std::span<const FoundPair>(sorted_[i]).subspan(first);
      compute_pairs(found_jobs_[i], rest.first(std::min(block_size, rest.size())), workers_[w],
                    records_.data() + place);
    }
  });
}

/// Computes the pairs of one block.
void ProximityPass::compute_pairs(std::uint32_t job, std::span<const FoundPair> found, Worker& worker,
                                  ProximityPair* pairs) {
  const ObjectPair objects{objects_[jobs_[job].a].id, objects_[jobs_[job].b].id};
  std::array<std::size_t, block_size> places;
  std::size_t count = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const FoundPair& pair = found[i];
    if (pair.crosses()) {
      const auto [edge, face] = with_points(crossing_of(job, pair.kind, pair.candidate));
      bool used_exact = false;
      pairs[i] = crossing_pair_of(edge, face, objects, order_of(job, pair.kind), used_exact);
      worker.stats.exact_fallbacks += used_exact ? 1 : 0;
      continue;
    }
    const auto kind = static_cast<ElementPairKind>(pair.kind);
    const Elements elements = elements_of(job, kind, pair.candidate);
    worker.elements[count] = with_points(job, kind, elements);
    const auto& [first, second] = worker.elements[count];
    worker.features[count] = {points_of(first, second), elements.features_of(pair.code)};
    places[count++] = i;
  }
  worker.batch.compute(std::span(worker.features).first(count), worker.distances,
                       worker.stats.exact_fallbacks);
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [first, second] = worker.elements[k];
    pairs[places[k]] = proximity_pair_of(first, second, worker.distances[k], objects,
                                         order_of(job, found[places[k]].kind), search_.listing);
  }
}

/// Orders the pairs of each job that found some, each once, and tells their number to the outcomes.
void ProximityPass::sort_found(const Parallel& parallel) {
  found_jobs_.clear();
  for (const Worker& worker : workers_) {
    for (const ProximityWorker::Run& run : worker.runs) found_jobs_.push_back(run.job);
  }
  sort_once(found_jobs_);
  if (sorted_.size() < found_jobs_.size()) sorted_.resize(found_jobs_.size());
  for (std::vector<FoundPair>& sorted : sorted_) sorted.clear();
  for (Worker& worker : workers_) std::ranges::sort(worker.runs, {}, &ProximityWorker::Run::job);
  parallel.for_ranges(found_jobs_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    for (std::size_t i = begin; i < end; ++i) {
      sort_job(found_jobs_[i], workers_[w].order, sorted_[i]);
      outcomes_.add({found_jobs_[i], 0, w, {Range{0, static_cast<std::uint32_t>(sorted_[i].size())}}});
    }
  });
}

/// Lists each pair of the job once, in canonical order.
void ProximityPass::sort_job(std::uint32_t job, BucketSort& order, std::vector<FoundPair>& sorted) const {
  const auto for_each = [&](const auto& visit) {
    for (const Worker& worker : workers_) {
      auto run = std::ranges::lower_bound(worker.runs, job, {}, &ProximityWorker::Run::job);
      for (; run != worker.runs.end() && run->job == job; ++run) {
        for (std::uint32_t i = run->first; i < run->end; ++i) visit(worker.found[i]);
      }
    }
  };
  const auto key_of = [](const FoundPair& found) {
    const auto& [kind_a, kind_b, element_a, element_b] = found.name;
    return SortKey{3 * static_cast<std::uint32_t>(kind_a) + static_cast<std::uint32_t>(kind_b), element_a[0]};
  };
  order.sort(for_each, key_of, std::less<>(), Parallel(1), sorted);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

}  // namespace supple
