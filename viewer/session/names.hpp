#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "supple/inspection.hpp"
#include "supple/motion.hpp"
#include "supple/options.hpp"

namespace supple::viewer {

/// What the values of an enumeration are called in commands and messages, in their order from 0.
template <class Enumeration>
inline constexpr std::array<const char*, 0> names_of{};

template <>
inline constexpr std::array names_of<BoundingVolume>{"aabb", "sphere"};
template <>
inline constexpr std::array names_of<BroadPhaseMethod>{"automatic", "octree", "grid", "sweep", "brute"};
template <>
inline constexpr std::array names_of<ContactKinds>{"none", "intersection", "continuous",
                                                   "intersection,continuous"};
template <>
inline constexpr std::array names_of<Integrator>{"verlet", "symplectic_euler", "backward_euler"};
template <>
inline constexpr std::array names_of<PairStage>{"not_tested",     "shared_vertex",  "inert",
                                                "object_volumes", "octree_volumes", "triangle_boxes",
                                                "exact_test",     "contact"};

template <class Enumeration>
const char* name_of(Enumeration value) {
  return names_of<Enumeration>[static_cast<std::size_t>(value)];
}

template <class Enumeration>
std::optional<Enumeration> named(std::string_view name) {
  for (std::size_t i = 0; i < names_of<Enumeration>.size(); ++i) {
    if (name == names_of<Enumeration>[i]) return static_cast<Enumeration>(i);
  }
  return std::nullopt;
}

/// `aabb, sphere`, for messages.
template <class Enumeration>
std::string list_of_names() {
  std::string list;
  for (const char* name : names_of<Enumeration>) {
    if (!list.empty()) list += ", ";
    list += name;
  }
  return list;
}

}  // namespace supple::viewer
