#include "answers/penetration/penetration_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/sort_once.hpp"
#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"
#include "queries/feature_name.hpp"

namespace supple {
namespace {

constexpr std::uint8_t is_visited = 1, is_triangle_corner = 2, is_on_surface = 4;

template <class List>
std::uint32_t size_of(const List& list) {
  return static_cast<std::uint32_t>(list.size());
}

template <class Item>
std::span<Item> part_of(std::vector<Item>& list, Range range) {
  return std::span(list).subspan(range.first, range.count);
}

}  // namespace

bool PenetrationPass::run(const PassInput& input, std::span<const PenetratedObject> objects,
                          const DetectResult& result, bool curves) {
  objects_ = objects;
  list_pairs(input.jobs);
  workers_.resize(input.parallel.worker_count());
  outcomes_.plan(pairs_, input.versions, std::exchange(with_curves_, curves) == curves, workers_.size());
  const std::span<const std::uint32_t> open = outcomes_.open_jobs();
  for (Worker& worker : workers_) {
    worker.curves.clear();
    worker.inside.clear();
    worker.on_surface.clear();
    worker.parts.clear();
  }
  input.parallel.for_ranges(open.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    for (std::size_t i = begin; i < end && !input.stop.stop_requested(); ++i) {
      const auto first = sizes_of(workers_[w]);
      run_task(task_of(pairs_[open[i]], result), result, workers_[w]);
      const auto last = sizes_of(workers_[w]);
      Outcomes::TaskOutcome outcome{open[i], 0, w, {}};
      for (std::size_t list = 0; list < list_count; ++list)
        outcome.ranges[list] = {first[list], last[list] - first[list]};
      outcomes_.add(outcome);
    }
  });
  if (input.stop.stop_requested()) return false;
  gather();
  if (!find_depths(input.stop, input.parallel)) return false;
  outcomes_.complete();
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

std::array<std::uint32_t, PenetrationPass::list_count> PenetrationPass::sizes_of(const Worker& worker) {
  const CurveLists& curves = worker.curves;
  return {size_of(worker.inside),  size_of(worker.on_surface), size_of(worker.parts),
          size_of(curves.curves),  size_of(curves.contacts),   size_of(curves.points),
          size_of(curves.enclosed)};
}

void PenetrationPass::run_task(const Task& task, const DetectResult& result, Worker& worker) const {
  const PenetratedObject &inner = objects_[task.inner], &outer = objects_[task.outer];
  if (task.inner != task.outer && outer.is_solid) find_inside(task, result, worker);
  if (with_curves_ && task.inner <= task.outer && task.group != nullptr)
    worker.curve_finder.find({inner.surface, outer.surface, &inner.queried, &outer.queried, inner.is_solid,
                              outer.is_solid, task.inner == task.outer, task.group, &result},
                             worker.curves);
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
      if (v != w && !is_cut(v, w)) worker.sets.join(worker.corner_of[v], worker.corner_of[w], false);
    }
  }
  const std::size_t first_inside = worker.inside.size(), first_on_surface = worker.on_surface.size();
  worker.has_contact.assign(around.parts().size(), 0);
  worker.state.resize(corners.size());
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    const std::uint32_t v = corners[c], root = worker.sets.find(c).root;
    worker.has_contact[around.part_of(v)] = 1;
    if (root == c) worker.state[c] = worker.queries.inside(0, outer.front(), inner.surface.position(v));
    if (worker.state[root] == Containment::on) worker.on_surface.push_back(v);
    if (worker.state[root] != Containment::inside) continue;
    marks[v] |= is_visited;
    worker.inside.push_back(v);
  }
  // A part without contacts is inside or outside as a whole.
  std::uint32_t contained = 0;
  for (std::uint32_t part = 0; part < around.parts().size(); ++part) {
    if (worker.has_contact[part] != 0) continue;
    const auto [vertex, count] = around.parts()[part];
    if (worker.queries.inside(0, outer.front(), inner.surface.position(vertex)) != Containment::inside)
      continue;
    ++contained;
    worker.parts.push_back({inner.queried.id, outer.front().id, vertex, count, false});
    marks[vertex] |= is_visited;
    worker.inside.push_back(vertex);
  }
  if (contained == around.parts().size()) {
    for (std::size_t i = worker.parts.size() - contained; i < worker.parts.size(); ++i)
      worker.parts[i].is_whole = true;
  }
  for (std::size_t next = first_inside; next < worker.inside.size(); ++next) {
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
  for (std::size_t i = first_inside; i < worker.inside.size(); ++i) marks[worker.inside[i]] = 0;
  worker.has_marks = false;
  std::sort(worker.inside.begin() + static_cast<std::ptrdiff_t>(first_inside), worker.inside.end());
  std::sort(worker.on_surface.begin() + static_cast<std::ptrdiff_t>(first_on_surface),
            worker.on_surface.end());
}

/// Pairs are in canonical order. Reused items move within the lists; new items are written between them. New
/// penetrations have no depth yet.
void PenetrationPass::gather() {
  outcomes_.place();
  outcomes_.move_known<of_penetrations>(penetrations_);
  outcomes_.move_known<of_surface>(on_surface_);
  outcomes_.move_known<of_parts>(parts_);
  outcomes_.move_known<of_curves>(curves_.curves);
  outcomes_.move_known<of_curve_contacts>(curves_.contacts);
  outcomes_.move_known<of_curve_points>(curves_.points);
  outcomes_.move_known<of_enclosed>(curves_.enclosed);
  groups_.clear();
  new_penetrations_.clear();
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    if (outcomes_.is_known(i)) {
      move_known_curves(i);
    } else {
      gather_found(i);
    }
    const Range inside = outcomes_.ranges(i)[of_penetrations], surface = outcomes_.ranges(i)[of_surface];
    const auto [inner, outer] = pairs_[outcomes_.job(i)];
    if (inside.count + surface.count > 0)
      groups_.push_back({objects_[inner].queried.id, objects_[outer].queried.id, inside.first, inside.count,
                         surface.first, surface.count});
  }
}

/// The curves and the contacts that they refer to have moved within their lists.
void PenetrationPass::move_known_curves(std::size_t i) {
  const Outcomes::Ranges &from = outcomes_.last_ranges(i), &to = outcomes_.ranges(i);
  move_ranges(i, from);
  const std::uint32_t change = to[of_curve_contacts].first - from[of_curve_contacts].first;
  for (std::uint32_t& contact : part_of(curves_.contacts, to[of_curve_contacts])) contact += change;
}

void PenetrationPass::gather_found(std::size_t i) {
  const Outcomes::TaskOutcome& outcome = outcomes_.tasks_of(i).front();
  const Outcomes::Ranges& from = outcome.ranges;
  const Outcomes::Ranges& to = outcomes_.ranges(i);
  const Worker& worker = workers_[outcome.worker];
  const ContactJob pair = pairs_[outcomes_.job(i)];
  const ObjectId inner = objects_[pair.a].queried.id, outer = objects_[pair.b].queried.id;
  for (std::uint32_t k = 0; k < to[of_penetrations].count; ++k) {
    const std::uint32_t place = to[of_penetrations].first + k;
    penetrations_[place] = {inner, outer, worker.inside[from[of_penetrations].first + k]};
    new_penetrations_.push_back(place);
  }
  const auto copy = [&](List list, const auto& found, auto& all) {
    std::copy_n(found.begin() + from[list].first, from[list].count, all.begin() + to[list].first);
  };
  copy(of_surface, worker.on_surface, on_surface_);
  copy(of_parts, worker.parts, parts_);
  copy(of_curves, worker.curves.curves, curves_.curves);
  copy(of_curve_contacts, worker.curves.contacts, curves_.contacts);
  copy(of_curve_points, worker.curves.points, curves_.points);
  copy(of_enclosed, worker.curves.enclosed, curves_.enclosed);
  move_ranges(i, from);
}

/// Renumbers the ranges of curves that were in other lists, or at other places.
void PenetrationPass::move_ranges(std::size_t i, const Outcomes::Ranges& from) {
  const Outcomes::Ranges& to = outcomes_.ranges(i);
  const auto change = [&](List list) { return to[list].first - from[list].first; };
  for (IntersectionCurve& curve : part_of(curves_.curves, to[of_curves])) {
    curve.first_contact += change(of_curve_contacts);
    curve.first_point += change(of_curve_points);
    curve.first_enclosed += change(of_enclosed);
  }
}

bool PenetrationPass::find_depths(const StopSignal& stop, const Parallel& parallel) {
  constexpr std::size_t grain = DistanceBatch::capacity;
  parallel.for_ranges(new_penetrations_.size(), grain,
                      [&](std::size_t begin, std::size_t end, std::uint32_t w) {
                        for (; begin < end && !stop.stop_requested(); begin += grain)
                          find_depths(begin, std::min(begin + grain, end), workers_[w]);
                      });
  return !stop.stop_requested();
}

/// Takes at most `DistanceBatch::capacity` new penetrations.
void PenetrationPass::find_depths(std::size_t begin, std::size_t end, Worker& worker) {
  std::array<FoundFeatures, DistanceBatch::capacity> found;
  std::array<ElementDistance, DistanceBatch::capacity> distances;
  ObjectId last_outer;
  for (std::size_t i = begin; i < end; ++i) {
    Penetration& penetration = penetrations_[new_penetrations_[i]];
    const PenetratedObject& outer = objects_[penetration.object_b.index];
    if (i == begin || penetration.object_b != last_outer) worker.queries.start();
    last_outer = penetration.object_b;
    // There is one, because the vertex is inside.
    const SurfaceView& inner = objects_[penetration.object_a.index].surface;
    const FoundTriangle nearest =
        *worker.queries.nearest(std::span(&outer.queried, 1), inner.position(penetration.vertex),
                                std::numeric_limits<double>::infinity());
    penetration.triangle = nearest.id;
    found[i - begin] = {nearest.elements(), nearest.features};
  }
  std::uint64_t exact_count = 0;
  worker.distances.compute(std::span(found).first(end - begin), distances, exact_count);
  for (std::size_t i = begin; i < end; ++i) {
    Penetration& penetration = penetrations_[new_penetrations_[i]];
    const ElementDistance& distance = distances[i - begin];
    penetration.feature = distance.on_b;
    penetration.depth = distance.distance;
    penetration.barycentric = distance.barycentric_b;
    penetration.point = distance.point_b;
    penetration.normal = Vec3d{} - distance.normal;
  }
}

}  // namespace supple
