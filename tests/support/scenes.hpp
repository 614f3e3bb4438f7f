#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"

namespace supple {

inline constexpr std::array all_bounding_volumes{BoundingVolume::aabb,   BoundingVolume::sphere,
                                                 BoundingVolume::obb,    BoundingVolume::kdop14,
                                                 BoundingVolume::kdop18, BoundingVolume::kdop26};
inline std::string name_of(BoundingVolume volume) {
  return words<BoundingVolume>[static_cast<std::size_t>(volume)];
}

/// FNV-1a over all results of a step: equal for results with equal bits.
inline std::uint64_t hash_of(const DetectResult& result, std::uint64_t hash = 0xcbf29ce484222325u) {
  const auto add = [&hash](const auto& value) {
    unsigned char bytes[sizeof(value)];
    std::memcpy(bytes, &value, sizeof(value));
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  };
  for (const ObjectPair& pair : result.object_pairs) {
    add(pair.a.index);
    add(pair.b.index);
  }
  for (const Contact& contact : result.contacts) {
    add(contact.object_a.index);
    add(contact.object_b.index);
    add(contact.triangle_a);
    add(contact.triangle_b);
    add(contact.kind);
    add(contact.point_count);
  }
  for (const ContactPoint& point : result.contact_points) {
    add(point.position.x);
    add(point.position.y);
    add(point.position.z);
    add(point.on_a);
    add(point.on_b);
  }
  for (const ContinuousContact& contact : result.continuous_contacts) {
    add(contact.object_a.index);
    add(contact.object_b.index);
    add(contact.kind);
    for (const auto& element : {contact.element_a, contact.element_b}) add(element);
    add(contact.certainty);
    add(contact.touching_at_start);
    add(contact.toi);
    add(contact.start_distance);
    for (const auto& weights : {contact.barycentric_a, contact.barycentric_b}) add(weights);
    add(contact.point);
    add(contact.normal);
  }
  for (const std::uint32_t vertex : result.colliding_vertices) add(vertex);
  for (const auto& pairs :
       {result.volume_events.begin, result.volume_events.end, result.contact_events.begin}) {
    for (const ObjectPair& pair : pairs) {
      add(pair.a.index);
      add(pair.b.index);
    }
  }
  return hash;
}

/// Separate from `hash_of`, whose values must not change.
inline std::uint64_t hash_of_normals(const DetectResult& result, std::uint64_t hash) {
  for (const Contact& contact : result.contacts) {
    for (int axis = 0; axis < 3; ++axis) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(contact.normal[axis])) * 0x100000001b3u;
    }
  }
  return hash;
}

inline std::uint64_t hash_of_proximity(std::span<const ProximityPair> pairs, std::uint64_t hash) {
  const auto add = [&](std::uint64_t value) {
    hash = (hash ^ value) * 0x100000001b3u;
    hash ^= hash >> 32;  // otherwise the signs of two numbers can cancel out
  };
  const auto add_numbers = [&](const std::array<double, 3>& numbers) {
    for (const double number : numbers) add(std::bit_cast<std::uint64_t>(number));
  };
  for (const ProximityPair& pair : pairs) {
    for (const ObjectId object : {pair.object_a, pair.object_b}) add(object.index);
    for (const FeatureKind kind : {pair.kind_a, pair.kind_b}) add(static_cast<std::uint64_t>(kind));
    for (const auto& element : {pair.element_a, pair.element_b}) {
      add(element[0]);
      add(element[1]);
    }
    for (const Feature& feature : {pair.on_a, pair.on_b})
      add(static_cast<std::uint64_t>(feature.kind) << 8 | feature.index);
    add(std::bit_cast<std::uint64_t>(pair.distance));
    add_numbers(pair.barycentric_a);
    add_numbers(pair.barycentric_b);
    for (const Vec3d& v : {pair.point_a, pair.point_b, pair.normal}) add_numbers({v.x, v.y, v.z});
  }
  return hash;
}

inline std::uint64_t hash_of_penetrations(const DetectResult& result,
                                          std::uint64_t hash = 0xcbf29ce484222325u) {
  const auto add = [&](std::uint64_t value) {
    hash = (hash ^ value) * 0x100000001b3u;
    hash ^= hash >> 32;
  };
  const auto add_vector = [&](const Vec3d& v) {
    for (int axis = 0; axis < 3; ++axis) add(std::bit_cast<std::uint64_t>(v[axis]));
  };
  for (const Penetration& p : result.penetrations) {
    for (const std::uint32_t id : {p.object_a.index, p.object_b.index, p.vertex, p.triangle}) add(id);
    add(static_cast<std::uint64_t>(p.feature.kind) << 8 | p.feature.index);
    add(std::bit_cast<std::uint64_t>(p.depth));
    for (const double weight : p.barycentric) add(std::bit_cast<std::uint64_t>(weight));
    add_vector(p.point);
    add_vector(p.normal);
  }
  for (const ContainedPart& part : result.contained_parts) {
    for (const std::uint32_t id : {part.inner.index, part.outer.index, part.vertex, part.vertex_count})
      add(id);
  }
  for (const IntersectionCurve& curve : result.curves) {
    add(static_cast<std::uint64_t>(curve.kind));
    for (const Vec3d& v : {curve.centroid, curve.area, curve.normal}) add_vector(v);
    add(std::bit_cast<std::uint64_t>(curve.depth));
  }
  for (const auto& list : {result.vertices_on_surface, result.curve_contacts, result.enclosed_vertices}) {
    for (const std::uint32_t id : list) add(id);
  }
  for (const Vec3d& point : result.curve_points) add_vector(point);
  return hash;
}

/// One line per difference that `verify` finds; empty if it agrees.
inline std::string differences(const Scene& scene) {
  std::string text;
  for (const Difference& d : verify(scene).differences) {
    text += (d.missed ? "missed " : "reported ") + std::to_string(d.object_a.index) + ":" +
            std::to_string(d.triangle_a) + " " + std::to_string(d.object_b.index) + ":" +
            std::to_string(d.triangle_b) + "\n";
  }
  return text;
}

}  // namespace supple
