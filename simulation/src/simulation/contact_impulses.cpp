#include "simulation/contact_impulses.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// The fraction of the missing distance that one step corrects (Bridson et al. use 0.1).
constexpr double repulsion_part = 0.1;
/// The fraction of the distance to the thickness by which elements may approach in one step. Normals turn
/// within a step, so with 1 many elements would come nearer than the thickness.
constexpr double approach_part = 0.5;

}  // namespace

bool ContactImpulses::resolve(Scene& scene, std::span<const ProximityPair> near,
                              std::span<const RespondingObject> objects, const DetectRequest& impacts,
                              const PairFilter& only) {
  begin(objects);
  touches_.clear();
  for (const ProximityPair& pair : near) {
    // An edge that crosses a face has no side to which it could be pushed.
    const bool is_face = pair.kind_a == FeatureKind::face || pair.kind_b == FeatureKind::face;
    const bool is_edge = pair.kind_a == FeatureKind::edge || pair.kind_b == FeatureKind::edge;
    if (!(is_face && is_edge)) touches_.push_back(touch_of(scene, pair));
  }
  for (std::uint32_t round = 0;; ++round) {
    const bool was_pushed = keep_apart();
    if (round > 0 && !was_pushed) return false;
    show_paths(scene);
    if (round == options_.iterations) return false;
    const auto found = scene.search(impacts, only).continuous_contacts;
    if (found.empty()) return true;
    for (const ContinuousContact& impact : found) touches_.push_back(touch_of(scene, impact));
  }
}

std::optional<ContactImpulses::Change> ContactImpulses::change(ObjectId object) const {
  const Participant& participant = participants_[object.index];
  if (!participant.is_changed) return std::nullopt;
  return Change{participant.changes[0], participant.changes[1]};
}

void ContactImpulses::begin(std::span<const RespondingObject> objects) {
  for (Participant& participant : participants_) participant.now.reset();
  for (const RespondingObject& object : objects) {
    Participant& participant = participant_of(object.id);
    participant.now = object;
    participant.is_changed = false;
    participant.is_stale = true;
    if (object.spread != nullptr) object.spread->begin_step();
    const std::size_t count = object.inverse_masses.size();
    participant.changes[0].assign(count, Vec3d{});
    participant.changes[1].assign(object.end_velocities.empty() ? 0 : count, Vec3d{});
  }
}

ContactImpulses::Participant& ContactImpulses::participant_of(ObjectId object) {
  if (participants_.size() <= object.index) participants_.resize(object.index + 1);
  return participants_[object.index];
}

void ContactImpulses::show_paths(Scene& scene) {
  for (Participant& object : participants_) {
    if (!object.now || !object.is_stale) continue;
    object.is_stale = false;
    to_.assign(object.now->to.begin(), object.now->to.end());
    if (object.is_changed) {
      for (std::size_t i = 0; i < to_.size(); ++i) to_[i] = to_[i] + seconds_ * object.changes[0][i];
    }
    scene.set_motion(object.now->id, object.now->from, to_);
  }
}

/// Elements bounce when they reach the thickness in this step or have reached it in the last one; otherwise
/// they rest.
ContactImpulses::Touch ContactImpulses::touch_of(const Scene& scene, const ProximityPair& pair) {
  Touch touch = unlimited_touch_of(scene, pair);
  const double missing = options_.thickness - pair.distance;
  auto& [average, end] = touch.least_speed;
  average = (missing > 0 ? repulsion_part : approach_part) * missing / seconds_;
  end = std::min(average, 0.0);
  if (-normal_speed(touch, Velocity::average) * seconds_ > std::abs(missing)) bounce(touch);
  return touch;
}

ContactImpulses::Touch ContactImpulses::touch_of(const Scene& scene, const ContinuousContact& impact) {
  Touch touch = unlimited_touch_of(scene, impact);
  bounce(touch);
  return touch;
}

template <class Contact>
ContactImpulses::Touch ContactImpulses::unlimited_touch_of(const Scene& scene, const Contact& contact) {
  participant_of(std::max(contact.object_a, contact.object_b));
  Touch touch{{contact.object_a.index, scene.vertices_of(contact, ContactSide::a), contact.barycentric_a},
              {contact.object_b.index, scene.vertices_of(contact, ContactSide::b), contact.barycentric_b},
              contact.normal};
  touch.mobility = mobility(touch.a, touch.a) + mobility(touch.b, touch.b) - mobility(touch.a, touch.b) -
                   mobility(touch.b, touch.a);
  return touch;
}

/// Restitution applies to the velocity at the end of the step.
void ContactImpulses::bounce(Touch& touch) const {
  const std::size_t last = velocity_count(touch) - 1;
  const double speed = -options_.restitution * normal_speed(touch, static_cast<Velocity>(last));
  if (speed > 0) touch.least_speed[last] = std::max(touch.least_speed[last], speed);
}

/// Projected Gauss-Seidel: each impulse corrects those before it, except for friction, and the sum of the
/// impulses on a touch never pulls. Returns whether there was an impulse.
bool ContactImpulses::keep_apart() {
  for (std::uint32_t sweep = 0; sweep < options_.iterations; ++sweep) {
    bool was_pushed = false;
    for (Touch& touch : touches_) {
      for (std::size_t kind = 0; kind < velocity_count(touch); ++kind) {
        if (keep_apart(touch, static_cast<Velocity>(kind))) was_pushed = true;
      }
    }
    if (!was_pushed) return sweep > 0;
  }
  return true;
}

bool ContactImpulses::keep_apart(Touch& touch, Velocity kind) {
  const auto k = static_cast<std::size_t>(kind);
  const double change = touch.least_speed[k] - normal_speed(touch, kind);
  const double impulse = std::max(change / touch.mobility, -touch.impulse[k]);
  if (!push_apart(touch, impulse, kind)) return false;
  touch.impulse[k] += impulse;
  return true;
}

/// Gives the elements an impulse along the normal and its opposite. Where it pushes, friction reduces the
/// sliding speed. Returns false when the impulse is negligible or nothing moves.
bool ContactImpulses::push_apart(const Touch& touch, double impulse, Velocity kind) {
  const double negligible = 1e-9 * options_.thickness / seconds_;
  if (!(std::abs(impulse) * touch.mobility > negligible)) return false;
  Vec3d all = touch.normal * impulse;
  if (options_.friction > 0 && impulse > 0) {
    const Vec3d relative = relative_velocity(touch, kind);
    const Vec3d slide = relative - touch.normal * dot(relative, touch.normal);
    const double slide_speed = norm(slide);
    const double slowed = std::min(options_.friction * impulse * touch.mobility, slide_speed);
    if (slide_speed > 0) all -= slide * (slowed / (slide_speed * touch.mobility));
  }
  if (!std::isfinite(squared_norm(all))) return false;
  push(touch.a, all, kind);
  push(touch.b, -all, kind);
  return true;
}

std::size_t ContactImpulses::velocity_count(const Touch& touch) const {
  const auto has_end = [&](const ElementPoint& point) {
    const Participant& object = participants_[point.object];
    return object.now && !object.now->end_velocities.empty();
  };
  return has_end(touch.a) || has_end(touch.b) ? 2 : 1;
}

double ContactImpulses::normal_speed(const Touch& touch, Velocity kind) const {
  return dot(relative_velocity(touch, kind), touch.normal);
}

Vec3d ContactImpulses::relative_velocity(const Touch& touch, Velocity kind) const {
  return velocity(touch.a, kind) - velocity(touch.b, kind);
}

Vec3d ContactImpulses::velocity(const ElementPoint& point, Velocity kind) const {
  const Participant& object = participants_[point.object];
  if (!object.now) return {};
  const std::vector<Vec3d>& changes = object.changes[static_cast<std::size_t>(kind)];
  const bool is_end = kind == Velocity::end && !object.now->end_velocities.empty();
  Vec3d sum;
  for (std::size_t i = 0; i < point.vertices.size(); ++i) {
    const std::uint32_t vertex = point.vertices[i];
    Vec3d v = is_end ? object.now->end_velocities[vertex]
                     : (object.now->to[vertex] - object.now->from[vertex]) * (1 / seconds_);
    if (!changes.empty()) v = v + changes[vertex];
    sum = sum + v * point.weights[i];
  }
  return sum;
}

/// The change of velocity of the second point per unit impulse on the first point.
double ContactImpulses::mobility(const ElementPoint& a, const ElementPoint& b) const {
  const Participant& object = participants_[a.object];
  if (a.object != b.object || !object.now || object.now->inverse_masses.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    for (std::size_t j = 0; j < b.vertices.size(); ++j) {
      const std::uint32_t from = a.vertices[i], to = b.vertices[j];
      const double share = object.now->spread != nullptr ? object.now->spread->share(from, to)
                           : from == to                  ? 1.0
                                                         : 0.0;
      sum += a.weights[i] * b.weights[j] * share * object.now->inverse_masses[to];
    }
  }
  return sum;
}

void ContactImpulses::push(const ElementPoint& point, Vec3d impulse, Velocity kind) {
  Participant& object = participants_[point.object];
  if (!object.now || object.now->inverse_masses.empty()) return;
  std::vector<Vec3d>& changes = object.changes[static_cast<std::size_t>(kind)];
  for (std::size_t i = 0; i < point.vertices.size(); ++i) {
    const std::uint32_t vertex = point.vertices[i];
    const Vec3d all = impulse * (point.weights[i] * object.now->inverse_masses[vertex]);
    if (object.now->spread == nullptr) {
      changes[vertex] = changes[vertex] + all;
      continue;
    }
    for (const ImpulseSpread::Share& share : object.now->spread->from(vertex))
      changes[share.vertex] = changes[share.vertex] + all * share.part;
  }
  object.is_changed = true;
  object.is_stale = true;
}

}  // namespace supple
