#include "answers/untested.hpp"

#include <algorithm>
#include <optional>

#include "geometry/vector.hpp"

namespace supple {

bool has_quality(ContactKinds kind, const ObjectOptions& object, bool has_motion) {
  const NothingToTest lack = info_of(kind).lack;
  if (lack == NothingToTest::no_motion) return has_motion;
  if (lack == NothingToTest::no_margin) return object.margin > 0;
  return lack != NothingToTest::no_solid || object.solid;
}

/// An element takes part by a finite edge of a triangle, or by all of its vertices. Without edges and points,
/// all of a triangle must be finite.
TestableObject testable_object(ContactKinds kind, ElementKinds elements, const WorldObject& object,
                               ObjectId id, bool tests_itself) {
  const bool on_the_way = info_of(kind).shape == SearchedShape::paths;
  const bool has_parts = info_of(kind).shape != SearchedShape::triangles;
  const bool only_edges = has_parts && elements == ElementKinds::edge_edge;
  TestableObject found{.id = id,
                       .has_quality = has_quality(kind, object.options, object.placement().has_motion()),
                       .is_static = object.options.is_static,
                       .group = object.options.group,
                       .mask = object.options.mask};
  const Placement& placement = object.placement();
  const auto is_usable = [&](std::uint32_t v) {
    return is_finite(placement.position(v)) && (!on_the_way || is_finite(placement.start_position(v)));
  };
  const std::size_t count = has_parts ? object.octree().id_count() : object.face_count();
  const int needed = tests_itself && kind != ContactKinds::penetration ? 2 : 1;
  int taking_part = 0;
  for (std::uint32_t e = 0; e < count && taking_part < needed; ++e) {
    if (!object.octree().has_triangle(e)) continue;
    const Triangle& corners = object.octree().user_triangle(e);
    if (only_edges && corners[0] == corners[2]) continue;
    found.has_elements = true;
    const auto usable = std::count_if(corners.begin(), corners.end(), is_usable);
    taking_part += usable >= (has_parts && e < object.face_count() ? 2 : 3) ? 1 : 0;
  }
  found.takes_part = taking_part > 0;
  found.tests_itself = taking_part > 1;
  return found;
}

std::optional<NothingToTest> TestableObjects::reason(ContactKinds kind) const {
  const auto count = [&](auto holds) { return std::count_if(objects_.begin(), objects_.end(), holds); };
  const auto taking_part = count([](const TestableObject& object) { return object.takes_part; });
  if (objects_.empty()) return NothingToTest::no_objects;
  if (count([](const TestableObject& object) { return object.has_elements; }) == 0)
    return NothingToTest::no_elements;
  if (taking_part == 0) return NothingToTest::not_finite;
  if (count([](const TestableObject& object) { return object.takes_part && object.has_quality; }) == 0)
    return info_of(kind).lack;
  if (taking_part == 1) return NothingToTest::one_object;
  if (count([](const TestableObject& object) { return object.takes_part && !object.is_static; }) == 0)
    return NothingToTest::all_static;
  if (pairs_left_ == 0) return std::nullopt;
  return is_filtered_ ? NothingToTest::filter : NothingToTest::groups;
}

std::optional<NothingToTest> UntestedKinds::nothing_to_test(const World& world, const Question& question,
                                                            ContactKinds kind) {
  objects_.clear();
  const auto accept = [&](ObjectId a, ObjectId b) { return question.may_pair(world, {a.index, b.index}); };
  for (std::uint32_t slot = 0; slot < world.slot_count(); ++slot) {
    const WorldObject* const object = world.at(slot);
    if (object == nullptr) continue;
    if (objects_.add(testable_object(kind, question.impact.kinds, *object, world.id_of(slot),
                                     question.tests_itself(world, slot)),
                     accept))
      return std::nullopt;
  }
  return objects_.reason(kind);
}

std::span<const UntestedKind> UntestedKinds::list(const World& world, const Question& question,
                                                  const DetectResult& found) {
  untested_.clear();
  for (const ContactKindInfo& of : contact_kinds) {
    if (of.is_in(found) || !contains(question.contacts, of.kind)) continue;
    if (const auto reason = nothing_to_test(world, question, of.kind))
      untested_.push_back({of.kind, *reason});
  }
  return untested_;
}

}  // namespace supple
