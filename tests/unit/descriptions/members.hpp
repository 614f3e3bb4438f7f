#pragma once

#include <tuple>

#include "supple/inspection_descriptions.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/simulation_descriptions.hpp"

// Lists the members of each described structure with structured bindings, which fail to compile when a
// structure gets another member. Describe the new member (supple/option_descriptions.hpp,
// result_descriptions.hpp or simulation_descriptions.hpp), then add a name here.

namespace supple {

inline auto members_of(ImpactOptions& o) {
  auto& [a, b, c, d] = o;
  return std::tie(a, b, c, d);
}
inline auto members_of(StepOptions& o) {
  auto& [a] = o;
  return std::tie(a);
}
inline auto members_of(ObjectOctreeOptions& o) {
  auto& [a, b, c, d, e] = o;
  return std::tie(a, b, c, d, e);
}
inline auto members_of(SceneOctreeOptions& o) {
  auto& [a, b, c, d, e, f, g] = o;
  return std::tie(a, b, c, d, e, f, g);
}
/// Lists of vertices and data of the user have no description: programs set them, not files or command lines.
inline auto members_of(ObjectOptions& o) {
  auto& [a, b, c, d, same_vertex, edges, points, e, f, g, h, i, j, user_data, k] = o;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k);
}
inline auto members_of(ComparisonOptions& o) {
  auto& [a, b, c, d] = o;
  return std::tie(a, b, c, d);
}
inline auto members_of(SceneOptions& o) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = o;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m);
}
inline auto members_of(BroadPhaseOptions& o) {
  auto& [a, b, c, d] = o;
  return std::tie(a, b, c, d);
}
inline auto members_of(MassSpringOptions& o) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, p, q, r] = o;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, p, q, r);
}
inline auto members_of(MassSpringMotion::Handle& o) {
  auto& [a, b, c] = o;
  return std::tie(a, b, c);
}
inline auto members_of(MassSpringMotion& o) {
  auto& [a, b, c, d, e, f, g, h] = o;
  return std::tie(a, b, c, d, e, f, g, h);
}
inline auto members_of(RigidMotion& o) {
  auto& [a, b, c, d, e] = o;
  return std::tie(a, b, c, d, e);
}
inline auto members_of(WaveMotion& o) {
  auto& [a, b, c, d, e] = o;
  return std::tie(a, b, c, d, e);
}
inline auto members_of(ContactResponse& o) {
  auto& [a, b, c, d] = o;
  return std::tie(a, b, c, d);
}
inline auto members_of(SimulationOptions& o) {
  auto& [a, b, c, d, e, f] = o;
  return std::tie(a, b, c, d, e, f);
}
inline auto members_of(StepStats& o) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, p, q, r, s, t, u, v, w, x, y, z, aa] = o;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, p, q, r, s, t, u, v, w, x, y, z, aa);
}
inline auto members_of(BroadPhaseStats& o) {
  auto& [a, b, c, d, e, f, g, h, i] = o;
  return std::tie(a, b, c, d, e, f, g, h, i);
}
inline auto members_of(OctreeStatistics& o) {
  auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = o;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
}
inline auto members_of(PolygonCounts& o) {
  auto& [a, b, c, d, e] = o;
  return std::tie(a, b, c, d, e);
}

}  // namespace supple
