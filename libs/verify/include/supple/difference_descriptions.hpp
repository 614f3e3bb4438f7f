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
struct Description<Difference> : RecordDescription<Difference> {
  static constexpr const char* name = "Difference";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object a", role::object('a'));
    field("object_b", &Row::object_b, "Object b", role::object('b'));
    field("triangle_a", &Row::triangle_a, "Triangle of object a", role::key(Names::triangle, 'a'));
    field("triangle_b", &Row::triangle_b, "Triangle of object b", role::key(Names::triangle, 'b'));
    field("missed", &Row::missed, "Whether the pair intersects and was not reported");
  }
};

template <>
struct Description<ContinuousDifference> : RecordDescription<ContinuousDifference> {
  static constexpr const char* name = "ContinuousDifference";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object a", role::object('a'));
    field("object_b", &Row::object_b, "Object b", role::object('b'));
    field("kind", &Row::kind, "Kinds of the elements", role::key(Names::nothing, 0));
    field("element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    field("element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    field("fault", &Row::fault, "What is wrong");
  }
};

template <>
struct Description<ProximityDifference> : RecordDescription<ProximityDifference> {
  static constexpr const char* name = "ProximityDifference";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object a", role::object('a'));
    field("object_b", &Row::object_b, "Object b", role::object('b'));
    field("kind_a", &Row::kind_a, "Kind of element a", role::key(Names::nothing, 'a'));
    field("kind_b", &Row::kind_b, "Kind of element b", role::key(Names::nothing, 'b'));
    field("element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    field("element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    field("fault", &Row::fault, "What is wrong");
  }
};

template <>
struct Description<PenetrationDifference> : RecordDescription<PenetrationDifference> {
  static constexpr const char* name = "PenetrationDifference";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object of the vertex", role::object('a'));
    field("object_b", &Row::object_b, "Solid object", role::object('b'));
    field("vertex", &Row::vertex, "Vertex of object a", role::key(Names::vertex, 'a'));
    field("fault", &Row::fault, "What is wrong");
  }
};

}  // namespace supple
