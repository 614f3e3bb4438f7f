#include "answers/penetration/penetration_pass.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/sort_once.hpp"
#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"
#include "queries/feature_name.hpp"

namespace supple {
namespace {

constexpr std::uint8_t is_visited = 1, is_triangle_corner = 2, is_on_surface = 4;

/// Calls `visit(number, list of p, list of q)` for the lists of two tuples.
template <class Lists, class Visit>
void for_each_list(Lists p, Lists q, const Visit& visit) {
  [&]<std::size_t... list>(std::index_sequence<list...>) {
    (visit(std::integral_constant<std::size_t, list>(), std::get<list>(p), std::get<list>(q)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Lists>>());
}

template <class Item>
std::span<Item> part_of(std::vector<Item>& list, Range range) {
  return std::span(list).subspan(range.first, range.count);
}

}  // namespace

bool PenetrationPass::run(const PassInput& input, std::span<const PenetratedObject> objects,
                          const PenetrationSearch& search, StepStats& stats) {
  const auto& [result, curves] = search;
  objects_ = objects;
  list_pairs(input.jobs);
  workers_.resize(input.parallel.worker_count());
  for (Worker& worker : workers_) {
    if (curves && !worker.curve_maker) worker.curve_maker = manifold_methods("curves").curve_maker();
  }
  outcomes_.plan(pairs_, input.versions, std::exchange(with_curves_, curves) == curves, workers_.size());
  const std::span<const std::uint32_t> open = outcomes_.open_jobs();
  for (Worker& worker : workers_) std::apply([](auto&... list) { (list.clear(), ...); }, worker.found.all());
  input.parallel.for_ranges(open.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    for (std::size_t i = begin; i < end && !input.stop.stop_requested(); ++i) {
      Outcomes::TaskOutcome outcome{open[i], 0, w, {}};
      const auto for_each_range = [&](const auto& visit) {
        const auto found = workers_[w].found.all();
        for_each_list(found, found, [&](auto number, const auto& list, const auto&) {
          visit(outcome.ranges[number], static_cast<std::uint32_t>(list.size()));
        });
      };
      for_each_range([](Range& range, std::uint32_t size) { range.first = size; });
      run_task(task_of(pairs_[open[i]], result), result, workers_[w]);
      for_each_range([](Range& range, std::uint32_t size) { range.count = size - range.first; });
      outcomes_.add(outcome);
    }
  });
  if (input.stop.stop_requested()) return false;
  gather();
  if (!find_depths(input.stop, input.parallel)) return false;
  outcomes_.complete();
  stats.penetrations = found_.penetrations.size();
  stats.curves = found_.curves.curves.size();
  return true;
}

void PenetrationPass::list_pairs(std::span<const ContactJob> jobs) {
  pairs_.clear();
  for (const auto& [a, b] : jobs) {
    pairs_.push_back({a, b});
    if (a != b && objects_[a].is_solid) pairs_.push_back({b, a});
  }
  std::sort(pairs_.begin(), pairs_.end());
}

PenetrationPass::Task PenetrationPass::task_of(ContactJob pair, const DetectResult& result) const {
  const auto [a, b] = std::minmax(pair.a, pair.b);
  const ObjectPair objects{objects_[a].queried.id, objects_[b].queried.id};
  const auto pair_of = [](const ContactGroup& group) { return ObjectPair{group.a, group.b}; };
  const auto group = std::ranges::lower_bound(result.groups, objects, {}, pair_of);
  const bool has_contacts = group != result.groups.end() && pair_of(*group) == objects;
  return {pair.a, pair.b, has_contacts ? &*group : nullptr};
}

void PenetrationPass::run_task(const Task& task, const DetectResult& result, Worker& worker) const {
  const PenetratedObject &inner = objects_[task.inner], &outer = objects_[task.outer];
  if (task.inner != task.outer && outer.is_solid) find_inside(task, result, worker);
  if (with_curves_ && task.inner <= task.outer && task.group != nullptr)
    worker.curve_maker->find({&inner, &outer, task.group, &result}, worker.found.curves);
}

/// Lists the triangles with contacts, their corners, and their edges that have a point in common with the
/// other object.
void PenetrationPass::collect_touched(const Task& task, const DetectResult& result, Worker& worker) const {
  const SurfaceView& surface = objects_[task.inner].surface;
  worker.triangles.clear();
  worker.corners.clear();
  worker.cut_edges.clear();
  if (task.group == nullptr) return;
  const bool inner_is_b = task.inner > task.outer;
  for (const Contact& contact : result.contacts_of(*task.group)) {
    const std::uint32_t id = inner_is_b ? contact.triangle_b : contact.triangle_a;
    worker.triangles.push_back(id);
    for (const ContactPoint& point : result.points_of(contact)) {
      const FeatureName name = name_of(inner_is_b ? point.on_b : point.on_a, surface.triangle(id), id);
      if (name.kind == FeatureKind::edge) worker.cut_edges.push_back({name.first, name.last});
      if (name.kind == FeatureKind::vertex) worker.marks[name.first] |= is_on_surface;
    }
  }
  sort_once(worker.triangles);
  bool used_exact = false;
  for (const std::uint32_t id : worker.triangles) {
    const Triangle& triangle = surface.triangle(id);
    worker.corners.insert(worker.corners.end(), triangle.begin(), triangle.end());
    // The contacts of a triangle without area do not name all of its features.
    const TrianglePoints corners = surface.corners(id);
    if (find_projection(corners[0], corners[1], corners[2], used_exact)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [v, w] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      worker.cut_edges.push_back({v, w});
    }
  }
  sort_once(worker.corners);
  sort_once(worker.cut_edges);
}

/// Appends the vertices of one object that are inside the other or on its surface, ascending, and the
/// contained parts.
void PenetrationPass::find_inside(const Task& task, const DetectResult& result, Worker& worker) const {
  const PenetratedObject& inner = objects_[task.inner];
  const VertexTriangles& around = *inner.surface.around;
  const std::span<const QueriedObject> outer(&objects_[task.outer].queried, 1);
  worker.queries.start();
  if (std::exchange(worker.has_marks, true)) std::fill(worker.marks.begin(), worker.marks.end(), 0);
  worker.marks.resize(std::max(worker.marks.size(), around.vertex_count()), 0);
  collect_touched(task, result, worker);
  auto& marks = worker.marks;
  const auto is_cut = [&](std::uint32_t v, std::uint32_t w) {
    if ((marks[v] & marks[w] & is_triangle_corner) == 0) return false;
    if (((marks[v] | marks[w]) & is_on_surface) != 0) return true;
    return std::binary_search(worker.cut_edges.begin(), worker.cut_edges.end(),
                              std::array{std::min(v, w), std::max(v, w)});
  };

  // Corners that edges of triangles with contacts connect are alike.
  const std::vector<std::uint32_t>& corners = worker.corners;
  worker.corner_of.resize(std::max(worker.corner_of.size(), around.vertex_count()));
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    marks[corners[c]] |= is_triangle_corner;
    worker.corner_of[corners[c]] = c;
  }
  worker.sets.start(corners.size());
  for (const std::uint32_t id : worker.triangles) {
    const Triangle& triangle = inner.surface.triangle(id);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangle[k], w = triangle[(k + 1) % 3];
      if (v != w && !is_cut(v, w)) worker.sets.join(worker.corner_of[v], worker.corner_of[w]);
    }
  }
  worker.inside.clear();
  const std::size_t first_part = worker.found.parts.size(), first_on_surface = worker.found.on_surface.size();
  worker.has_contact.assign(around.parts().size(), 0);
  worker.state.resize(corners.size());
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    const std::uint32_t v = corners[c], root = worker.sets.root(c);
    worker.has_contact[around.part_of(v)] = 1;
    if (root == c) worker.state[c] = worker.queries.inside(0, outer.front(), inner.surface.position(v));
    if (worker.state[root] == Containment::on) worker.found.on_surface.push_back(v);
    if (worker.state[root] != Containment::inside) continue;
    marks[v] |= is_visited;
    worker.inside.push_back(v);
  }
  // A part without contacts is inside or outside as a whole.
  for (std::uint32_t part = 0; part < around.parts().size(); ++part) {
    if (worker.has_contact[part] != 0) continue;
    const auto [vertex, count] = around.parts()[part];
    if (worker.queries.inside(0, outer.front(), inner.surface.position(vertex)) != Containment::inside)
      continue;
    worker.found.parts.push_back({inner.queried.id, outer.front().id, vertex, count, false});
    marks[vertex] |= is_visited;
    worker.inside.push_back(vertex);
  }
  const auto contained = std::span(worker.found.parts).subspan(first_part);
  for (ContainedPart& part : contained) part.is_whole = contained.size() == around.parts().size();
  for (std::size_t next = 0; next < worker.inside.size(); ++next) {
    const std::uint32_t v = worker.inside[next];
    for (const std::uint32_t t : around.around(v)) {
      for (const std::uint32_t w : inner.surface.triangle(t)) {
        if ((marks[w] & is_visited) != 0 || is_cut(v, w)) continue;
        marks[w] |= is_visited;
        worker.inside.push_back(w);
      }
    }
  }
  for (const std::uint32_t v : corners) marks[v] = 0;
  for (const std::uint32_t v : worker.inside) marks[v] = 0;
  worker.has_marks = false;
  std::ranges::sort(worker.inside);
  for (const std::uint32_t v : worker.inside)
    worker.found.penetrations.push_back({inner.queried.id, outer.front().id, v});
  std::ranges::sort(std::span(worker.found.on_surface).subspan(first_on_surface));
}

/// Pairs are in canonical order. Reused items move within the lists; new items are written between them. New
/// penetrations have no depth yet.
void PenetrationPass::gather() {
  outcomes_.place();
  const auto lists = found_.all();
  for_each_list(lists, lists,
                [&](auto number, auto& list, const auto&) { outcomes_.template move_known<number>(list); });
  groups_.clear();
  new_penetrations_.clear();
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    if (!outcomes_.is_known(i)) copy_found(i);
    renumber_curves(i);
    const Range inside = outcomes_.ranges(i)[of_penetrations], surface = outcomes_.ranges(i)[of_surface];
    const auto [inner, outer] = pairs_[outcomes_.job(i)];
    if (inside.count + surface.count > 0)
      groups_.push_back({objects_[inner].queried.id, objects_[outer].queried.id, inside.first, inside.count,
                         surface.first, surface.count});
  }
}

void PenetrationPass::copy_found(std::size_t i) {
  const Outcomes::TaskOutcome& outcome = outcomes_.tasks_of(i).front();
  const Outcomes::Ranges& to = outcomes_.ranges(i);
  for_each_list(workers_[outcome.worker].found.all(), found_.all(), [&](auto number, auto& from, auto& list) {
    std::ranges::copy(part_of(from, outcome.ranges[number]), list.begin() + to[number].first);
  });
  for (std::uint32_t k = to[of_penetrations].first; k < to[of_penetrations].end(); ++k)
    new_penetrations_.push_back(k);
}

/// The curves, and what they refer to, were in other lists or at other places.
void PenetrationPass::renumber_curves(std::size_t i) {
  const bool is_known = outcomes_.is_known(i);
  const Outcomes::Ranges &from = is_known ? outcomes_.last_ranges(i) : outcomes_.tasks_of(i).front().ranges,
                         &to = outcomes_.ranges(i);
  const auto change = [&](List list) { return to[list].first - from[list].first; };
  for (IntersectionCurve& curve : part_of(found_.curves.curves, to[of_curves])) {
    curve.first_contact += change(of_curve_contacts);
    curve.first_point += change(of_curve_points);
    curve.first_enclosed += change(of_enclosed);
  }
  if (!is_known) return;
  for (std::uint32_t& contact : part_of(found_.curves.contacts, to[of_curve_contacts]))
    contact += change(of_curve_contacts);
}

bool PenetrationPass::find_depths(const StopSignal& stop, const Parallel& parallel) {
  constexpr std::size_t grain = 1024;
  parallel.for_ranges(
      new_penetrations_.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
        const auto objects_of = [&](std::uint32_t i) {
          return ObjectPair{found_.penetrations[i].object_a, found_.penetrations[i].object_b};
        };
        for (std::span open = std::span(new_penetrations_).subspan(begin, end - begin); !open.empty();) {
          const ObjectPair objects = objects_of(open.front());
          const auto next =
              std::ranges::find_if(open, [&](std::uint32_t i) { return objects_of(i) != objects; });
          std::span of_pair(open.begin(), next);
          open = {next, open.end()};
          sort_by_place(of_pair, workers_[w]);
          workers_[w].queries.start();
          for (std::size_t count = 0; !of_pair.empty() && !stop.stop_requested();
               of_pair = of_pair.subspan(count)) {
            count = std::min(DistanceBatch::capacity, of_pair.size());
            find_depths(of_pair.first(count), workers_[w]);
          }
        }
      });
  return !stop.stop_requested();
}

/// Neighbours follow each other, because they descend together.
void PenetrationPass::sort_by_place(std::span<std::uint32_t> penetrations, Worker& worker) const {
  worker.numbers.assign(penetrations.begin(), penetrations.end());
  worker.points.clear();
  worker.order.clear();
  for (const std::uint32_t i : penetrations) {
    const Penetration& penetration = found_.penetrations[i];
    worker.order.push_back({0, static_cast<std::uint32_t>(worker.points.size())});
    worker.points.push_back(objects_[penetration.object_a.index].surface.position(penetration.vertex));
  }
  sort_along_curve(worker.order, worker.points, worker.memory);
  for (std::size_t k = 0; k < penetrations.size(); ++k)
    penetrations[k] = worker.numbers[worker.order[k].triangle];
}

/// Takes at most `DistanceBatch::capacity` penetrations of two objects.
void PenetrationPass::find_depths(std::span<const std::uint32_t> penetrations, Worker& worker) {
  std::array<FoundFeatures, DistanceBatch::capacity> found;
  std::array<ElementDistance, DistanceBatch::capacity> distances;
  const auto penetration_of = [&](std::size_t i) -> Penetration& {
    return found_.penetrations[penetrations[i]];
  };
  const std::span outer(&objects_[penetration_of(0).object_b.index].queried, 1);
  const SurfaceView& inner = objects_[penetration_of(0).object_a.index].surface;
  for (std::size_t i = 0; i < penetrations.size();) {
    std::array<Vec3d, PointPacket::capacity> points;
    std::array<std::optional<FoundTriangle>, PointPacket::capacity> nearest;
    const std::size_t count = std::min(points.size(), penetrations.size() - i);
    for (std::size_t k = 0; k < count; ++k) points[k] = inner.position(penetration_of(i + k).vertex);
    worker.queries.nearest(outer, std::span(points).first(count), std::numeric_limits<double>::infinity(),
                           nearest);
    // There is one, because the vertex is inside.
    for (std::size_t k = 0; k < count; ++k, ++i) {
      penetration_of(i).triangle = nearest[k]->id;
      found[i] = {nearest[k]->elements(), {}};
    }
  }
  worker.distances.find(std::span(found).first(penetrations.size()), distances);
  for (std::size_t i = 0; i < penetrations.size(); ++i) {
    Penetration& penetration = penetration_of(i);
    const ElementDistance& distance = distances[i];
    penetration.feature = distance.on_b;
    penetration.depth = distance.distance;
    penetration.barycentric = distance.barycentric_b;
    penetration.point = distance.point_b;
    penetration.normal = Vec3d{} - distance.normal;
  }
}

}  // namespace supple
