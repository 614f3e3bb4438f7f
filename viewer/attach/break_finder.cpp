#include "break_finder.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "supple/error.hpp"
#include "supple/option_descriptions.hpp"

namespace supple::viewer {
namespace {

std::string short_text(double value) {
  return text_of(std::round(value * 1e6) / 1e6);
}

/// Where two objects touch first in the lists.
std::optional<Vec3d> contact_point(const Scene& scene, ObjectId a, ObjectId b) {
  const DetectResult& result = scene.result();
  for (const ContactGroup& group : result.groups) {
    if (group.a != a || group.b != b) continue;
    const Contact& contact = result.contacts_of(group).front();
    const auto points = result.points_of(contact);
    if (!points.empty()) return points.front().position;
    return scene.position(a, scene.vertices_of(contact, ContactSide::a)[0]);
  }
  for (const ContactGroup& group : result.continuous_groups) {
    if (group.a == a && group.b == b) return result.continuous_contacts_of(group).front().point;
  }
  return std::nullopt;
}

bool is_of(const std::array<std::string, 2>& objects, const std::string& a, const std::string& b) {
  const auto fits = [](const std::string& wanted, const std::string& name) {
    return wanted.empty() || wanted == name;
  };
  return (fits(objects[0], a) && fits(objects[1], b)) || (fits(objects[0], b) && fits(objects[1], a));
}

Break between(const Scene& scene, const char* event, ObjectId a, ObjectId b, const char* what) {
  std::string text = scene.options(a).name + " " + what + " ";
  text += a == b ? "itself" : scene.options(b).name;
  return {event, std::move(text), scene.result().step, {a, b}, contact_point(scene, a, b)};
}

std::optional<Break> new_contact(const Scene& scene, const BreakOptions& breaks) {
  for (const ObjectPair& pair : scene.result().contact_events.begin) {
    if (is_of(breaks.objects, scene.options(pair.a).name, scene.options(pair.b).name))
      return between(scene, "contact_begin", pair.a, pair.b, "begins to touch");
  }
  return std::nullopt;
}

const Penetration* deepest(std::span<const Penetration> penetrations) {
  const auto found = std::max_element(penetrations.begin(), penetrations.end(),
                                      [](const auto& p, const auto& q) { return p.depth < q.depth; });
  return found == penetrations.end() ? nullptr : &*found;
}

Break too_deep(const Scene& scene, const Penetration& found) {
  std::string text = "a vertex of ";
  text += scene.options(found.object_a).name + " is " + short_text(found.depth) + " deep in " +
          scene.options(found.object_b).name;
  return {"depth_above",
          std::move(text),
          scene.result().step,
          {found.object_a, found.object_b},
          scene.position(found.object_a, found.vertex)};
}

Break too_many(const Scene& scene, std::uint64_t count) {
  const DetectResult& result = scene.result();
  Break found{"contacts_above", "there are " + std::to_string(count) + " contacts", result.step, {}, {}};
  if (!result.groups.empty()) {
    const ContactGroup& group = result.groups.front();
    found.objects = {group.a, group.b};
    found.point = contact_point(scene, group.a, group.b);
  }
  return found;
}

Break not_finite(const Scene& scene) {
  const NonFiniteVertex& vertex = scene.result().non_finite_vertices.front();
  std::string text = "vertex ";
  text += std::to_string(vertex.vertex) + " of " + scene.options(vertex.object).name + " is NaN or infinite";
  return {"not_finite", std::move(text), scene.result().step, {vertex.object, std::nullopt}, {}};
}

}  // namespace

void check(const BreakOptions& breaks, ContactKinds detected) {
  const ContactKinds kinds = with_included(detected);
  const auto need = [&](bool is_wanted, const char* event, ContactKinds one, ContactKinds other) {
    if (!is_wanted || contains(kinds, one) || contains(kinds, other)) return;
    throw Error(std::string(event) + ": the scene does not detect " + word_of(one) +
                ", so this never happens; add it to the contacts of the scene");
  };
  using enum ContactKinds;
  need(breaks.contact_begin, "contact_begin", intersection, continuous);
  need(breaks.intersection, "intersection", intersection, intersection);
  need(breaks.depth_above.has_value(), "depth_above", penetration, penetration);
}

std::optional<Break> BreakFinder::find(const Scene& scene, const BreakOptions& breaks) {
  const DetectResult& result = scene.result();
  std::optional<Break> found;
  const auto check = [&](std::size_t event, bool holds, const auto& describe) {
    if (begins(event, holds) && !found) found = describe();
  };
  check(0, breaks.not_finite && !result.non_finite_vertices.empty(), [&] { return not_finite(scene); });
  if (!found && breaks.contact_begin) found = new_contact(scene, breaks);
  check(1, breaks.intersection && !result.contacts.empty(), [&] {
    const ContactGroup& group = result.groups.front();
    return between(scene, "intersection", group.a, group.b, "intersects");
  });
  const std::uint64_t count = result.stats.contacts + result.stats.proximity_pairs;
  check(2, breaks.contacts_above && count > *breaks.contacts_above, [&] { return too_many(scene, count); });
  const Penetration* const deep = breaks.depth_above ? deepest(result.penetrations) : nullptr;
  check(3, deep != nullptr && deep->depth > *breaks.depth_above, [&] { return too_deep(scene, *deep); });
  return found;
}

bool BreakFinder::begins(std::size_t event, bool holds) {
  return !std::exchange(lasts_[event], holds) && holds;
}

}  // namespace supple::viewer
