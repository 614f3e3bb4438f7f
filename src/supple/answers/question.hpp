#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "answers/search_options.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/safe_step.hpp"
#include "world/world.hpp"

namespace supple {

/// What a search looks for.
struct Question {
  ContactKinds contacts = ContactKinds::none;
  ImpactSearchOptions impact{};
  ProximityListing proximity_listing = ProximityListing::features;
  bool contact_points = false;
  bool colliding_vertices = false;
  bool lazy_refit = false;
  bool manifolds = false;
  bool curves = false;
  std::optional<StepOptions> safe_step{};  ///< continuous contacts: for a safe step
  /// Only these pairs of objects of those that the world lets through; all when it is empty. For an object
  /// with self-collision, both ids are the same.
  PairFilter only{};

  bool has_intersections() const { return contains(contacts, ContactKinds::intersection); }
  bool is_continuous() const { return contains(contacts, ContactKinds::continuous); }
  bool has_penetration() const { return contains(contacts, ContactKinds::penetration); }
  /// It searches this kind; without kinds, it counts the candidates of intersections.
  bool searches(ContactKinds kind) const {
    return contains(contacts, kind) || (contacts == ContactKinds::none && kind == ContactKinds::intersection);
  }
  /// It searches a kind that reads this shape.
  bool reads(SearchedShape shape) const {
    return std::ranges::any_of(
        contact_kinds, [&](const ContactKindInfo& of) { return of.shape == shape && searches(of.kind); });
  }
  bool searches_at_rest() const { return reads(SearchedShape::triangles); }
  SearchedShapes shapes() const {
    const bool only_intersections = with_included(contacts) == ContactKinds::intersection;
    return {searches_at_rest(), reads(SearchedShape::paths), reads(SearchedShape::margins),
            lazy_refit && (contacts == ContactKinds::none || only_intersections),
            // Colliding vertices and distances need all overlapping leaves, so nothing may be culled.
            searches_at_rest() && !colliding_vertices,
            is_continuous() && impact.impact.min_separation == 0 && !safe_step};
  }

  bool may_pair(const World& world, const IndexPair& pair) const {
    return world.may_pair(pair) && accepts(world, pair.a, pair.b);
  }
  bool tests_itself(const World& world, std::uint32_t slot) const {
    return world[slot].options.self_collision && accepts(world, slot, slot);
  }
  bool has_filter(const World& world) const { return world.has_filter() || only; }

  /// The shape of an object that the search reads.
  OctreeView view(const WorldObject& object) const {
    if (searches_at_rest()) return object.resting_view();
    return reads(SearchedShape::paths) ? object.moving_view() : object.near_view();
  }
  /// The separation at which elements of two objects touch.
  double separation_of(const WorldObject& a, const WorldObject& b) const {
    return supple::separation_of(impact.impact.min_separation, a.options.min_separation,
                                 b.options.min_separation);
  }

 private:
  bool accepts(const World& world, std::uint32_t a, std::uint32_t b) const {
    return !only || only(world.id_of(a), world.id_of(b));
  }
};

/// What a request asks of a scene with these options. Throws `Error` when the request is out of range.
Question question_of(const DetectRequest& request, const SceneOptions& options);

}  // namespace supple
