#include "scene/penetration_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"
#include "scene/feature_name.hpp"

namespace supple {
namespace {

constexpr std::uint8_t is_visited = 1, is_corner = 2, is_on_surface = 4;

template <class List>
void sort_once(List& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

template <class List>
std::uint32_t size_of(const List& list) {
  return static_cast<std::uint32_t>(list.size());
}

/// Appends a range of another list.
template <class Item>
void append(std::vector<Item>& list, const std::vector<Item>& from, std::uint32_t first,
            std::uint32_t count) {
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
  list.insert(list.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

bool PenetrationPass::run(std::span<const ContactJob> jobs, std::span<const PenetratedObject> objects,
                          const DetectResult& result, const StopSignal& stop, const Parallel& parallel) {
  objects_ = objects;
  plan(jobs, result);
  workers_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.curves.clear();
    worker.inside.clear();
    worker.on_surface.clear();
    worker.parts.clear();
  }
  outcomes_.assign(tasks_.size(), {});
  parallel.for_ranges(tasks_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      outcomes_[i].worker = w;
      run_task(tasks_[i], result, workers_[w], outcomes_[i]);
    }
  });
  if (stop.stop_requested()) return false;
  gather();
  return find_depths(stop, parallel);
}

void PenetrationPass::plan(std::span<const ContactJob> jobs, const DetectResult& result) {
  tasks_.clear();
  auto group = result.groups.begin();
  for (const auto& [a, b] : jobs) {
    const bool has_contacts = group != result.groups.end() && group->a == objects_[a].queried.id &&
                              group->b == objects_[b].queried.id;
    const ContactGroup* const contacts = has_contacts ? &*group++ : nullptr;
    if (has_contacts) tasks_.push_back({a, b, contacts, true, false});
    if (a == b) continue;
    if (objects_[b].is_solid) tasks_.push_back({a, b, contacts, false, false});
    if (objects_[a].is_solid) tasks_.push_back({b, a, contacts, false, true});
  }
  std::sort(tasks_.begin(), tasks_.end(), [](const Task& p, const Task& q) {
    return std::tie(p.inner, p.outer, p.finds_curves) < std::tie(q.inner, q.outer, q.finds_curves);
  });
}

void PenetrationPass::run_task(const Task& task, const DetectResult& result, Worker& worker,
                               Outcome& outcome) const {
  if (task.finds_curves) {
    outcome.first_curve = size_of(worker.curves.curves);
    worker.curve_finder.find({objects_[task.inner].surface, objects_[task.outer].surface,
                              task.inner == task.outer, task.group, &result},
                             worker.curves);
    outcome.curves = size_of(worker.curves.curves) - outcome.first_curve;
    return;
  }
  outcome.first_inside = size_of(worker.inside);
  outcome.first_on_surface = size_of(worker.on_surface);
  outcome.first_part = size_of(worker.parts);
  find_inside(task, result, worker);
  outcome.inside = size_of(worker.inside) - outcome.first_inside;
  outcome.on_surface = size_of(worker.on_surface) - outcome.first_on_surface;
  outcome.parts = size_of(worker.parts) - outcome.first_part;
}

/// Lists the triangles with contacts, their corners, and their edges that have a point in common with the
/// other object.
void PenetrationPass::collect_touched(const Task& task, const DetectResult& result, Worker& worker) const {
  const SurfaceView& surface = objects_[task.inner].surface;
  worker.triangles.clear();
  worker.corners.clear();
  worker.cut_edges.clear();
  if (task.group == nullptr) return;
  for (const Contact& contact : result.contacts_of(*task.group)) {
    const std::uint32_t id = task.inner_is_b ? contact.triangle_b : contact.triangle_a;
    worker.triangles.push_back(id);
    for (const ContactPoint& point : result.points_of(contact)) {
      const FeatureName name = name_of(task.inner_is_b ? point.on_b : point.on_a, surface.triangle(id), id);
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
  if (outer.front().has_inert_faces) return;
  worker.queries.start();
  worker.marks.resize(std::max(worker.marks.size(), around.vertex_count()), 0);
  collect_touched(task, result, worker);
  auto& marks = worker.marks;
  const auto is_cut = [&](std::uint32_t v, std::uint32_t w) {
    if ((marks[v] & marks[w] & is_corner) == 0) return false;
    if (((marks[v] | marks[w]) & is_on_surface) != 0) return true;
    return std::binary_search(worker.cut_edges.begin(), worker.cut_edges.end(),
                              std::array{std::min(v, w), std::max(v, w)});
  };

  // Corners that edges of triangles with contacts connect are alike.
  const std::vector<std::uint32_t>& corners = worker.corners;
  for (const std::uint32_t v : corners) marks[v] |= is_corner;
  const auto corner = [&](std::uint32_t vertex) {
    return static_cast<std::uint32_t>(std::lower_bound(corners.begin(), corners.end(), vertex) -
                                      corners.begin());
  };
  worker.sets.start(corners.size());
  for (const std::uint32_t id : worker.triangles) {
    const Triangle& triangle = inner.surface.triangle(id);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangle[k], w = triangle[(k + 1) % 3];
      if (v != w && !is_cut(v, w)) worker.sets.join(corner(v), corner(w), false);
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
  std::sort(worker.inside.begin() + static_cast<std::ptrdiff_t>(first_inside), worker.inside.end());
  std::sort(worker.on_surface.begin() + static_cast<std::ptrdiff_t>(first_on_surface),
            worker.on_surface.end());
}

/// Writes the lists of the workers in the order of the tasks. Penetrations have no depth yet.
void PenetrationPass::gather() {
  groups_.clear();
  penetrations_.clear();
  on_surface_.clear();
  parts_.clear();
  curves_.clear();
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const Outcome& outcome = outcomes_[i];
    const Worker& worker = workers_[outcome.worker];
    const ObjectId inner = objects_[tasks_[i].inner].queried.id, outer = objects_[tasks_[i].outer].queried.id;
    if (outcome.inside + outcome.on_surface > 0)
      groups_.push_back(
          {inner, outer, size_of(penetrations_), outcome.inside, size_of(on_surface_), outcome.on_surface});
    for (std::uint32_t k = 0; k < outcome.inside; ++k)
      penetrations_.push_back({inner, outer, worker.inside[outcome.first_inside + k]});
    append(on_surface_, worker.on_surface, outcome.first_on_surface, outcome.on_surface);
    append(parts_, worker.parts, outcome.first_part, outcome.parts);
    for (std::uint32_t k = 0; k < outcome.curves; ++k) {
      IntersectionCurve curve = worker.curves.curves[outcome.first_curve + k];
      const auto move = [](auto& list, const auto& from, std::uint32_t& first, std::uint32_t count) {
        const std::uint32_t begin = size_of(list);
        append(list, from, first, count);
        first = begin;
      };
      move(curves_.contacts, worker.curves.contacts, curve.first_contact, curve.contact_count);
      move(curves_.points, worker.curves.points, curve.first_point, curve.point_count);
      move(curves_.enclosed, worker.curves.enclosed, curve.first_enclosed,
           curve.enclosed_count_a + curve.enclosed_count_b);
      curves_.curves.push_back(curve);
    }
  }
}

bool PenetrationPass::find_depths(const StopSignal& stop, const Parallel& parallel) {
  constexpr std::size_t grain = 64;
  parallel.for_ranges(penetrations_.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    ObjectQueries& queries = workers_[w].queries;
    ObjectId last_outer;
    for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      Penetration& penetration = penetrations_[i];
      const PenetratedObject& inner = objects_[penetration.object_a.index];
      const PenetratedObject& outer = objects_[penetration.object_b.index];
      if (i == begin || penetration.object_b != last_outer) queries.start();
      last_outer = penetration.object_b;
      // There is one, because the vertex is inside.
      const ClosestPoint closest =
          *queries.closest(std::span(&outer.queried, 1), inner.surface.position(penetration.vertex),
                           std::numeric_limits<double>::infinity());
      penetration.triangle = closest.triangle;
      penetration.feature = closest.feature;
      penetration.depth = closest.distance;
      penetration.barycentric = closest.barycentric;
      penetration.point = closest.point;
      penetration.normal = Vec3d{} - closest.normal;
    }
  });
  return !stop.stop_requested();
}

}  // namespace supple
