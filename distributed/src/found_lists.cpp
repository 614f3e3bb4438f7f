#include "found_lists.hpp"

#include <algorithm>
#include <tuple>

#include "core/sort_once.hpp"

namespace supple {
namespace {

auto key(const Contact& c) {
  return std::tuple(c.object_a, c.object_b, c.triangle_a, c.triangle_b);
}
auto key(const ContinuousContact& c) {
  return std::tuple(c.object_a, c.object_b, c.kind, c.element_a, c.element_b);
}
auto key(const ProximityPair& p) {
  return std::tuple(p.object_a, p.object_b, p.kind_a, p.kind_b, p.element_a, p.element_b);
}
auto key(const PenetrationGroup& g) {
  return std::tuple(g.a, g.b);
}
auto key(const ContainedPart& p) {
  return std::tuple(p.inner, p.outer, p.vertex);
}
/// The curves of two objects are on one rank, and so their contacts are in their order.
auto key(const IntersectionCurve& c) {
  return std::tuple(c.a, c.b, c.first_contact);
}
auto key(const NonFiniteVertex& v) {
  return std::tuple(v.object, v.vertex);
}

/// Returns whether anything changed its place. Lists of one rank are in order.
template <class Record>
bool sort_records(std::vector<Record>& records) {
  const auto before = [](const Record& p, const Record& q) { return key(p) < key(q); };
  if (std::is_sorted(records.begin(), records.end(), before)) return false;
  std::sort(records.begin(), records.end(), before);
  return true;
}

/// Puts ranges of a list into the order of the records that own them.
template <class Item>
class Reordered {
 public:
  explicit Reordered(std::vector<Item>& items) : items_(items) { ordered_.reserve(items.size()); }
  ~Reordered() { items_.swap(ordered_); }
  Reordered(const Reordered&) = delete;
  Reordered& operator=(const Reordered&) = delete;

  void take(std::uint32_t& first, std::size_t count) {
    const auto from = items_.begin() + static_cast<std::ptrdiff_t>(first);
    first = static_cast<std::uint32_t>(ordered_.size());
    ordered_.insert(ordered_.end(), from, from + static_cast<std::ptrdiff_t>(count));
  }

 private:
  std::vector<Item>& items_;
  std::vector<Item> ordered_;
};

template <class Record>
void list_groups(const std::vector<Record>& records, std::vector<ContactGroup>& groups) {
  groups.clear();
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (groups.empty() || groups.back().a != records[i].object_a || groups.back().b != records[i].object_b)
      groups.push_back({records[i].object_a, records[i].object_b, static_cast<std::uint32_t>(i), 0});
    ++groups.back().contact_count;
  }
}

}  // namespace

bool is_before(const ContinuousContact& p, const ContinuousContact& q) {
  return key(p) < key(q);
}

template <class Lists, class Visit>
void FoundLists::visit(Lists& lists, const Visit& visit) {
  for (auto& list : lists.pairs) visit(list);
  visit(lists.contacts);
  visit(lists.contact_points);
  visit(lists.continuous_contacts);
  visit(lists.proximity_pairs);
  visit(lists.penetration_groups);
  visit(lists.penetrations);
  visit(lists.vertices_on_surface);
  visit(lists.contained_parts);
  visit(lists.curves);
  visit(lists.curve_contacts);
  visit(lists.curve_points);
  visit(lists.enclosed_vertices);
  visit(lists.non_finite_vertices);
}

void FoundLists::clear() {
  visit(*this, [](auto& list) { list.clear(); });
}

bool FoundLists::is_empty() const {
  bool is_empty = true;
  visit(*this, [&](const auto& list) { is_empty = is_empty && list.empty(); });
  return is_empty;
}

void FoundLists::write(Writer& to) const {
  visit(*this, [&](const auto& list) { to.put_all(list); });
}

void FoundLists::append(Reader& from) {
  const std::size_t old_contacts = contacts.size(), old_groups = penetration_groups.size(),
                    old_curves = curves.size();
  const auto size = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  const std::uint32_t points = size(contact_points), depths = size(penetrations),
                      on_surface = size(vertices_on_surface), linked = size(curve_contacts),
                      curve_point = size(curve_points), enclosed = size(enclosed_vertices);
  visit(*this, [&](auto& list) { from.append_all(list); });
  for (std::size_t i = old_contacts; i < contacts.size(); ++i) contacts[i].first_point += points;
  for (std::size_t i = old_groups; i < penetration_groups.size(); ++i) {
    penetration_groups[i].first_penetration += depths;
    penetration_groups[i].first_on_surface += on_surface;
  }
  for (std::size_t i = old_curves; i < curves.size(); ++i) {
    curves[i].first_contact += linked;
    curves[i].first_point += curve_point;
    curves[i].first_enclosed += enclosed;
  }
}

void FoundLists::sort() {
  for (std::vector<ObjectPair>& list : pairs) sort_once(list);
  sort_records(continuous_contacts);
  sort_records(proximity_pairs);
  sort_records(contained_parts);
  sort_records(non_finite_vertices);
  // Parts of an object share the vertices on their borders.
  const auto end = std::unique(non_finite_vertices.begin(), non_finite_vertices.end(),
                               [](const auto& p, const auto& q) { return key(p) == key(q); });
  non_finite_vertices.erase(end, non_finite_vertices.end());
  if (sort_records(contacts) && !contact_points.empty()) {
    Reordered points(contact_points);
    for (Contact& contact : contacts) points.take(contact.first_point, contact.point_count);
  }
  if (sort_records(penetration_groups)) {
    Reordered depths(penetrations);
    Reordered on_surface(vertices_on_surface);
    for (PenetrationGroup& group : penetration_groups) {
      depths.take(group.first_penetration, group.penetration_count);
      on_surface.take(group.first_on_surface, group.on_surface_count);
    }
  }
  if (!sort_records(curves)) return;
  Reordered linked(curve_contacts);
  Reordered points(curve_points);
  Reordered enclosed(enclosed_vertices);
  for (IntersectionCurve& curve : curves) {
    linked.take(curve.first_contact, curve.contact_count);
    points.take(curve.first_point, curve.point_count);
    enclosed.take(curve.first_enclosed, std::size_t{curve.enclosed_count_a} + curve.enclosed_count_b);
  }
}

void FoundLists::list(DetectResult& result) {
  list_groups(contacts, groups_);
  list_groups(continuous_contacts, continuous_groups_);
  list_groups(proximity_pairs, proximity_groups_);
  for (const IntersectionCurve& curve : curves) {
    const auto group = std::lower_bound(
        groups_.begin(), groups_.end(), std::tuple(curve.a, curve.b),
        [](const ContactGroup& p, const auto& objects) { return std::tuple(p.a, p.b) < objects; });
    for (std::uint32_t i = 0; i < curve.contact_count; ++i)
      curve_contacts[curve.first_contact + i] += group->first_contact;
  }
  result.object_pairs = pairs[static_cast<std::size_t>(PairList::volumes)];
  result.groups = groups_;
  result.contacts = contacts;
  result.contact_points = contact_points;
  result.continuous_groups = continuous_groups_;
  result.continuous_contacts = continuous_contacts;
  result.proximity_groups = proximity_groups_;
  result.proximity_pairs = proximity_pairs;
  result.penetration_groups = penetration_groups;
  result.penetrations = penetrations;
  result.vertices_on_surface = vertices_on_surface;
  result.contained_parts = contained_parts;
  result.curves = curves;
  result.curve_contacts = curve_contacts;
  result.curve_points = curve_points;
  result.enclosed_vertices = enclosed_vertices;
  result.non_finite_vertices = non_finite_vertices;
}

}  // namespace supple
