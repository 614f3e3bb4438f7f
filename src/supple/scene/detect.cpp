#include <algorithm>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "scene/scene_implementation.hpp"
#include "scene/verify.hpp"

namespace supple {

const DetectResult& Scene::Implementation::detect() {
  result.stats = {};
  Timer total, stage;
  refit_objects();
  result.stats.refit_seconds = stage.lap();
  find_object_pairs();
  result.stats.broad_phase_seconds = stage.lap();
  find_contacts();
  stage.lap();
  report_non_finite();
  publish();
  result.stats.finish_seconds += stage.lap();
  result.stats.total_seconds = total.lap();
  return result;
}

/// Large objects take all workers one after the other; small ones go side by side.
void Scene::Implementation::refit_objects() {
  constexpr std::size_t large = 16384;  // triangles
  boxes_.resize(slots_.size());
  spheres_.resize(slots_.size());
  changed_.resize(slots_.size(), 0);
  stale_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    SceneObject* const object = slots_[index].object.get();
    if (object == nullptr || !object->is_stale()) continue;
    changed_[index] = 1;
    if (object->needs_refit()) {
      ++result.stats.objects_refitted;
      result.stats.triangles_refitted += object->octree().triangles().size();
    }
    if (object->octree().triangles().size() >= large) {
      object->update(parallel);
    } else {
      stale_.push_back(index);
    }
  }
  parallel.for_ranges(stale_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) slots_[stale_[i]].object->update(serial);
  });
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    if (changed_[index] == 0) continue;
    const SceneObject* const object = slots_[index].object.get();
    boxes_[index] = object != nullptr ? object->box() : Aabb{};
    spheres_[index] = object != nullptr ? object->sphere() : BoundingSphere{};
  }
}

void Scene::Implementation::find_object_pairs() {
  ObjectVolumes volumes;
  volumes.changed = changed_;
  if (options.bounding_volume == BoundingVolume::sphere) {
    volumes.spheres = spheres_;
  } else {
    volumes.boxes = boxes_;
  }
  pair_finder->find_pairs(volumes, parallel, index_pairs_);
  std::fill(changed_.begin(), changed_.end(), std::uint8_t{0});
  result.stats.object_pairs_tested = pair_finder->stats().object_pairs_tested;
  object_pairs_.clear();
  for (const IndexPair& pair : index_pairs_) {
    if (may_pair(pair)) object_pairs_.push_back({id_of(pair.a), id_of(pair.b)});
  }
  result.stats.object_pairs = object_pairs_.size();
}

bool Scene::Implementation::may_pair(const IndexPair& pair) const {
  const ObjectOptions& a = slots_[pair.a].object->options;
  const ObjectOptions& b = slots_[pair.b].object->options;
  if (a.is_static && b.is_static) return false;
  if ((a.group & b.mask) == 0 || (b.group & a.mask) == 0) return false;
  return !filter || filter(id_of(pair.a), id_of(pair.b));
}

void Scene::Implementation::find_contacts() {
  contact_objects_.clear();
  jobs_.clear();
  auto pair = object_pairs_.begin();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    contact_objects_.emplace_back();
    if (object == nullptr) continue;
    contact_objects_.back() = {id_of(index), object->view(), object->octree().triangle_ids(),
                               object->octree().vertex_ids()};
    if (object->options.self_collision) jobs_.push_back({index, index});
    for (; pair != object_pairs_.end() && pair->a.index == index; ++pair)
      jobs_.push_back({index, pair->b.index});
  }
  contact_pass_.run(jobs_, contact_objects_, options, parallel, result.stats);
}

void Scene::Implementation::report_non_finite() {
  non_finite_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object == nullptr) continue;
    for (const std::uint32_t vertex : object->non_finite_vertices()) {
      non_finite_.push_back(
          {id_of(index), vertex, object->position(object->octree().vertex_order()[vertex])});
    }
  }
}

void Scene::Implementation::publish() {
  touching_pairs_.clear();
  for (const ContactGroup& group : contact_pass_.groups()) {
    if (group.a != group.b) touching_pairs_.push_back({group.a, group.b});
  }
  volume_pairs_.update(object_pairs_);
  contact_pairs_.update(touching_pairs_);
  result.step = step_++;
  result.object_pairs = object_pairs_;
  result.groups = contact_pass_.groups();
  result.contacts = contact_pass_.contacts();
  result.contact_points = contact_pass_.contact_points();
  result.colliding_vertex_groups = contact_pass_.colliding_vertex_groups();
  result.colliding_vertices = contact_pass_.colliding_vertices();
  result.non_finite_vertices = non_finite_;
  result.volume_events = volume_pairs_.events();
  result.contact_events = contact_pairs_.events();
  detected_ = true;
}

/// All pairs that `detect` must look at, found without volumes: those whose filters agree.
std::vector<ObjectPair> Scene::Implementation::pairs_to_verify() const {
  std::vector<ObjectPair> pairs;
  for (const ObjectId a : objects()) {
    if (slots_[a.index].object->options.self_collision) pairs.push_back({a, a});
    for (const ObjectId b : objects()) {
      if (a < b && may_pair({a.index, b.index})) pairs.push_back({a, b});
    }
  }
  return pairs;
}

namespace {

PlainObject plain_object(const SceneObject& object, std::vector<Triangle>& triangles) {
  const ObjectOctree& octree = object.octree();
  PlainObject plain;
  plain.positions.reserve(octree.vertex_order().size());
  for (const std::uint32_t vertex : octree.vertex_order()) plain.positions.push_back(object.position(vertex));
  triangles.resize(octree.triangles().size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Triangle& corners = octree.triangles()[t];
    for (int corner = 0; corner < 3; ++corner) {
      triangles[octree.triangle_ids()[t]][corner] = octree.vertex_ids()[corners[corner]];
    }
  }
  plain.triangles = triangles;
  return plain;
}

}  // namespace

VerifyReport Scene::Implementation::verify() const {
  if (!detected_) fail("verify: nothing was detected at the present positions; call detect first");
  if (options.contacts == ContactMode::none)
    fail("verify: the scene has contacts switched off; there is nothing to compare");
  VerifyReport report;
  auto group = result.groups.begin();
  for (const ObjectPair& pair : pairs_to_verify()) {
    std::vector<Triangle> triangles_a, triangles_b;
    const bool same_object = pair.a == pair.b;
    const PlainObject a = plain_object(*slots_[pair.a.index].object, triangles_a);
    const PlainObject b = same_object ? a : plain_object(*slots_[pair.b.index].object, triangles_b);
    const std::vector<TrianglePair> truth = intersecting_pairs_by_brute_force(a, b, same_object, parallel);
    std::vector<TrianglePair> reported;
    if (group != result.groups.end() && group->a == pair.a && group->b == pair.b) {
      for (const Contact& contact : result.contacts_of(*group)) {
        reported.push_back({contact.triangle_a, contact.triangle_b});
      }
      ++group;
    }
    const std::uint64_t count_a = triangles_a.size();
    report.triangle_pairs_checked += same_object
                                         ? count_a * (count_a - std::min<std::uint64_t>(count_a, 1)) / 2
                                         : count_a * triangles_b.size();
    report.intersecting_pairs += truth.size();
    const auto note = [&](const std::vector<TrianglePair>& from, const std::vector<TrianglePair>& without,
                          bool missed) {
      std::vector<TrianglePair> difference;
      std::set_difference(from.begin(), from.end(), without.begin(), without.end(),
                          std::back_inserter(difference));
      for (const TrianglePair& p : difference)
        report.differences.push_back({pair.a, pair.b, p.a, p.b, missed});
    };
    note(truth, reported, true);
    note(reported, truth, false);
  }
  return report;
}

}  // namespace supple
