#pragma once

#include "supple/record_descriptions.hpp"
#include "supple/verify.hpp"

// Descriptions of the differences that `verify` reports.

namespace supple {

template <>
inline constexpr std::array words<ContinuousDifference::Fault>{"missed", "added", "late", "early"};
template <>
inline constexpr std::array words<ProximityDifference::Fault>{"missed", "added", "inexact"};
template <>
inline constexpr std::array words<PenetrationDifference::Fault>{"missed", "added", "inexact"};

template <>
struct Description<Difference> {
  static constexpr const char* name = "Difference";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = Difference;
    visit_field(visitor, "object_a", &Row::object_a, "Object a", role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Object b", role::object('b'));
    visit_field(visitor, "triangle_a", &Row::triangle_a, "Triangle of object a",
                role::key(Names::triangle, 'a'));
    visit_field(visitor, "triangle_b", &Row::triangle_b, "Triangle of object b",
                role::key(Names::triangle, 'b'));
    visit_field(visitor, "missed", &Row::missed, "Whether the pair intersects and was not reported");
  }
};

template <>
struct Description<ContinuousDifference> {
  static constexpr const char* name = "ContinuousDifference";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ContinuousDifference;
    visit_field(visitor, "object_a", &Row::object_a, "Object a", role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Object b", role::object('b'));
    visit_field(visitor, "kind", &Row::kind, "Kinds of the elements", role::key(Names::nothing, 0));
    visit_field(visitor, "element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    visit_field(visitor, "element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    visit_field(visitor, "fault", &Row::fault, "What is wrong");
  }
};

template <>
struct Description<ProximityDifference> {
  static constexpr const char* name = "ProximityDifference";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ProximityDifference;
    visit_field(visitor, "object_a", &Row::object_a, "Object a", role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Object b", role::object('b'));
    visit_field(visitor, "kind_a", &Row::kind_a, "Kind of element a", role::key(Names::nothing, 'a'));
    visit_field(visitor, "kind_b", &Row::kind_b, "Kind of element b", role::key(Names::nothing, 'b'));
    visit_field(visitor, "element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    visit_field(visitor, "element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    visit_field(visitor, "fault", &Row::fault, "What is wrong");
  }
};

template <>
struct Description<PenetrationDifference> {
  static constexpr const char* name = "PenetrationDifference";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = PenetrationDifference;
    visit_field(visitor, "object_a", &Row::object_a, "Object of the vertex", role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Solid object", role::object('b'));
    visit_field(visitor, "vertex", &Row::vertex, "Vertex of object a", role::key(Names::vertex, 'a'));
    visit_field(visitor, "fault", &Row::fault, "What is wrong");
  }
};

}  // namespace supple
