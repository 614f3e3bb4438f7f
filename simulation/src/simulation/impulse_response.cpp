#include "simulation/impulse_response.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// The fraction of the overlap that one step corrects (Bridson et al. use 0.1).
constexpr double repulsion_part = 0.1;

SceneOptions scene_options(const ContactResponse& response, std::uint32_t threads) {
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  options.impact.min_separation = response.thickness;
  // Resting elements are exactly at the limit of touching. The response need not decide these cases exactly.
  options.impact.exact = false;
  options.threads = threads;
  return options;
}

}  // namespace

ImpulseResponse::ImpulseResponse(const ContactResponse& options, double seconds, std::uint32_t threads)
    : options_(options), seconds_(seconds), scene_(scene_options(options, threads)) {
  scene_.set_pair_filter([this](ObjectId a, ObjectId b) {
    return participants_[a.index].has_mass || participants_[b.index].has_mass;
  });
}

ObjectId ImpulseResponse::add(const TriangleMesh& mesh, const ObjectOptions& options,
                              const MassSpringOptions* springs) {
  const bool has_mass = springs != nullptr;
  ObjectOptions own = options;
  own.is_static = false;
  own.self_collision = options.self_collision && has_mass;
  const ObjectId id = scene_.add(mesh, own);
  if (participants_.size() <= id.index) participants_.resize(id.index + 1);
  Participant& object = participants_[id.index];
  object = {};
  object.triangles = mesh.triangles;
  object.has_mass = has_mass;
  if (has_mass) object.spread.emplace(mesh, *springs, seconds_);
  return id;
}

void ImpulseResponse::remove(ObjectId object) {
  scene_.remove(object);
  participants_[object.index] = {};
}

void ImpulseResponse::set_positions(ObjectId object, std::span<const Vec3d> positions) {
  scene_.set_positions(object, positions);
}

void ImpulseResponse::resolve(std::span<const RespondingObject> objects) {
  begin(objects);
  for (std::uint32_t round = 0; round < options_.iterations; ++round) {
    show_paths();
    bool pushed = false;
    for (const ContinuousContact& contact : scene_.detect().continuous_contacts) {
      if (respond(contact)) pushed = true;
    }
    if (!pushed) return;
  }
}

std::optional<ImpulseResponse::Change> ImpulseResponse::change(ObjectId object) const {
  const Participant& participant = participants_[object.index];
  if (!participant.is_changed) return std::nullopt;
  return Change{participant.changes[0], participant.changes[1]};
}

void ImpulseResponse::begin(std::span<const RespondingObject> objects) {
  moving_.clear();
  for (const RespondingObject& object : objects) {
    Participant& participant = participants_[object.id.index];
    participant.now = object;
    participant.is_resting = object.from.data() == object.to.data();
    participant.is_changed = false;
    participant.is_stale = !participant.is_resting;
    if (participant.has_mass) {
      participant.spread->begin_step();
      for (auto& changes : participant.changes) changes.assign(object.from.size(), Vec3d{});
    }
    if (!participant.is_resting) moving_.push_back(object.id);
  }
}

void ImpulseResponse::show_paths() {
  for (const ObjectId id : moving_) {
    Participant& object = participants_[id.index];
    if (!object.is_stale) continue;
    object.is_stale = false;
    to_.assign(object.now.to.begin(), object.now.to.end());
    if (object.is_changed) {
      for (std::size_t i = 0; i < to_.size(); ++i) to_[i] = to_[i] + seconds_ * object.changes[0][i];
    }
    scene_.set_motion(id, object.now.from, to_);
  }
}

bool ImpulseResponse::respond(const ContinuousContact& contact) {
  const ElementPoint a = point_of(contact.object_a, contact.element_a,
                                  contact.kind == ElementPairKind::face_vertex, contact.barycentric_a);
  const ElementPoint b = point_of(contact.object_b, contact.element_b,
                                  contact.kind == ElementPairKind::vertex_face, contact.barycentric_b);
  double parting = 0;
  double restitution = options_.restitution;
  if (contact.touching_at_start) {
    parting = repulsion_part * std::max(options_.thickness - contact.start_distance, 0.0) / seconds_;
    restitution = 0;  // resting contact does not bounce
  }
  const bool moved = push_apart(a, b, contact.normal, parting, 0, Velocity::average);
  return push_apart(a, b, contact.normal, 0, restitution, Velocity::end) || moved;
}

/// Raises the normal speed to at least `least_speed` and to the speed that restitution demands; reduces the
/// sliding speed by at most `friction` times that change. Returns false when nothing had to change.
bool ImpulseResponse::push_apart(const ElementPoint& a, const ElementPoint& b, Vec3d normal,
                                 double least_speed, double restitution, Velocity kind) {
  const double mobility = mobility_of_both(a, b);
  if (!(mobility > 0)) return false;
  const Vec3d relative = velocity(a, kind) - velocity(b, kind);
  const double speed = dot(relative, normal);
  const double change = std::max(least_speed, -restitution * speed) - speed;
  const double rounding = 1e-9 * options_.thickness / seconds_;
  if (!(change > rounding)) return false;

  Vec3d impulse = normal * (change / mobility);
  const Vec3d slide = relative - normal * speed;
  const double slide_speed = std::sqrt(dot(slide, slide));
  if (options_.friction > 0 && slide_speed > 0) {
    const double slowed = std::min(options_.friction * change, slide_speed);
    impulse = impulse - slide * (slowed / (slide_speed * mobility));
  }
  if (!std::isfinite(dot(impulse, impulse))) return false;
  push(a, impulse, kind);
  push(b, impulse * -1.0, kind);
  return true;
}

ImpulseResponse::ElementPoint ImpulseResponse::point_of(ObjectId object,
                                                        const std::array<std::uint32_t, 2>& element,
                                                        bool is_face, const std::array<double, 3>& weights) {
  ElementPoint point{&participants_[object.index], {}, weights, 3};
  if (is_face) {
    point.vertices = point.object->triangles[element[0]];
  } else {
    point.vertices = {element[0], element[1], 0};
    point.count = element[0] == element[1] ? 1 : 2;
  }
  return point;
}

Vec3d ImpulseResponse::velocity(const ElementPoint& point, Velocity kind) const {
  const Participant& object = *point.object;
  if (object.is_resting) return {};
  Vec3d sum;
  for (std::uint32_t i = 0; i < point.count; ++i) {
    const std::uint32_t vertex = point.vertices[i];
    const bool is_end = kind == Velocity::end && object.has_mass;
    Vec3d v = is_end ? object.now.velocities[vertex]
                     : (object.now.to[vertex] - object.now.from[vertex]) * (1 / seconds_);
    if (object.has_mass) v = v + object.changes[static_cast<std::size_t>(kind)][vertex];
    sum = sum + v * point.weights[i];
  }
  return sum;
}

/// The change of velocity of the second point per unit impulse on the first point.
double ImpulseResponse::mobility(const ElementPoint& a, const ElementPoint& b) const {
  if (a.object != b.object || !a.object->has_mass) return 0;
  double sum = 0;
  for (std::uint32_t i = 0; i < a.count; ++i) {
    for (std::uint32_t j = 0; j < b.count; ++j)
      sum += a.weights[i] * b.weights[j] * a.object->spread->share(a.vertices[i], b.vertices[j]);
  }
  return sum * a.object->now.inverse_mass;
}

/// The change of relative velocity per unit impulse on one point and its opposite on the other.
double ImpulseResponse::mobility_of_both(const ElementPoint& a, const ElementPoint& b) const {
  return mobility(a, a) + mobility(b, b) - mobility(a, b) - mobility(b, a);
}

void ImpulseResponse::push(const ElementPoint& point, Vec3d impulse, Velocity kind) {
  Participant& object = *point.object;
  if (!object.has_mass) return;
  for (std::uint32_t i = 0; i < point.count; ++i) {
    const Vec3d all = impulse * (point.weights[i] * object.now.inverse_mass);
    for (const ImpulseSpread::Share& share : object.spread->from(point.vertices[i])) {
      Vec3d& change = object.changes[static_cast<std::size_t>(kind)][share.vertex];
      change = change + all * share.part;
    }
  }
  object.is_changed = true;
  object.is_stale = true;
}

}  // namespace supple
