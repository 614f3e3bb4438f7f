#include "found_lists.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/sort_once.hpp"

namespace supple {
namespace {

/// What follows in a message.
enum class Kind : std::uint8_t {
  contact,
  continuous,
  proximity,
  penetrations,
  contained,
  curve,
  non_finite,
  pair,
};

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
auto key(const IntersectionCurve& c) {
  return std::tuple(c.a, c.b);
}
auto key(const NonFiniteVertex& v) {
  return std::tuple(v.object, v.vertex);
}

template <class Record>
void sort_records(std::vector<Record>& records) {
  std::stable_sort(records.begin(), records.end(),
                   [](const Record& p, const Record& q) { return key(p) < key(q); });
}
template <class Record>
void sort_records_once(std::vector<Record>& records) {
  sort_records(records);
  const auto end = std::unique(records.begin(), records.end(),
                               [](const Record& p, const Record& q) { return key(p) == key(q); });
  records.erase(end, records.end());
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

/// Appends the items of a message and returns where the first one is.
template <class Item>
std::uint32_t append(Reader& from, std::vector<Item>& items) {
  const std::size_t first = items.size();
  from.append_all(items);
  return static_cast<std::uint32_t>(first);
}

}  // namespace

bool is_before(const ContinuousContact& p, const ContinuousContact& q) {
  return key(p) < key(q);
}

void write_record(const DetectResult& found, const Contact& contact, Writer& to) {
  to.put(Kind::contact);
  to.put(contact);
  to.put_all(found.points_of(contact));
}
void write_record(const DetectResult&, const ContinuousContact& contact, Writer& to) {
  to.put(Kind::continuous);
  to.put(contact);
}
void write_record(const DetectResult&, const ProximityPair& pair, Writer& to) {
  to.put(Kind::proximity);
  to.put(pair);
}
void write_record(const ContainedPart& part, Writer& to) {
  to.put(Kind::contained);
  to.put(part);
}
void write_record(const NonFiniteVertex& vertex, Writer& to) {
  to.put(Kind::non_finite);
  to.put(vertex);
}
void write_pair(PairList list, const ObjectPair& pair, Writer& to) {
  to.put(Kind::pair);
  to.put(list);
  to.put(pair);
}
void write_record(const PenetrationGroup& group, const std::vector<Penetration>& penetrations,
                  const std::vector<std::uint32_t>& on_surface, Writer& to) {
  to.put(Kind::penetrations);
  to.put(group);
  to.put_all(penetrations);
  to.put_all(on_surface);
}
void write_record(const DetectResult& found, const IntersectionCurve& curve,
                  const std::vector<std::uint32_t>& contacts, const std::vector<std::uint32_t>& enclosed,
                  Writer& to) {
  to.put(Kind::curve);
  to.put(curve);
  to.put_all(contacts);
  to.put_all(found.points_of(curve));
  to.put_all(enclosed);
}

void FoundLists::read(Reader& from) {
  while (!from.is_done()) {
    switch (from.get<Kind>()) {
      case Kind::contact:
        contacts.push_back(from.get<Contact>());
        contacts.back().first_point = append(from, contact_points);
        break;
      case Kind::continuous:
        continuous_contacts.push_back(from.get<ContinuousContact>());
        break;
      case Kind::proximity:
        proximity_pairs.push_back(from.get<ProximityPair>());
        break;
      case Kind::penetrations:
        penetration_groups.push_back(from.get<PenetrationGroup>());
        penetration_groups.back().first_penetration = append(from, penetrations);
        penetration_groups.back().first_on_surface = append(from, vertices_on_surface);
        break;
      case Kind::contained:
        contained_parts.push_back(from.get<ContainedPart>());
        break;
      case Kind::curve:
        curves.push_back(from.get<IntersectionCurve>());
        curves.back().first_contact = append(from, curve_contacts);
        curves.back().first_point = append(from, curve_points);
        curves.back().first_enclosed = append(from, enclosed_vertices);
        break;
      case Kind::non_finite:
        non_finite_vertices.push_back(from.get<NonFiniteVertex>());
        break;
      case Kind::pair: {
        const auto list = static_cast<std::size_t>(from.get<PairList>());
        pairs[list].push_back(from.get<ObjectPair>());
        break;
      }
    }
  }
}

void FoundLists::arrange() {
  for (std::vector<ObjectPair>& list : pairs) sort_once(list);
  sort_records_once(contacts);
  sort_records_once(continuous_contacts);
  sort_records_once(proximity_pairs);
  sort_records(penetration_groups);
  sort_records(contained_parts);
  sort_records(curves);
  sort_records_once(non_finite_vertices);
  if (!contact_points.empty()) {
    Reordered points(contact_points);
    for (Contact& contact : contacts) points.take(contact.first_point, contact.point_count);
  }
  {
    Reordered depths(penetrations);
    Reordered on_surface(vertices_on_surface);
    for (PenetrationGroup& group : penetration_groups) {
      depths.take(group.first_penetration, group.penetration_count);
      on_surface.take(group.first_on_surface, group.on_surface_count);
    }
  }
  list_groups(contacts, groups);
  list_groups(continuous_contacts, continuous_groups);
  list_groups(proximity_pairs, proximity_groups);
  {
    Reordered linked(curve_contacts);
    Reordered points(curve_points);
    Reordered enclosed(enclosed_vertices);
    for (IntersectionCurve& curve : curves) {
      linked.take(curve.first_contact, curve.contact_count);
      points.take(curve.first_point, curve.point_count);
      enclosed.take(curve.first_enclosed, std::size_t{curve.enclosed_count_a} + curve.enclosed_count_b);
    }
  }
  for (const IntersectionCurve& curve : curves) {
    const auto group = std::lower_bound(
        groups.begin(), groups.end(), std::tuple(curve.a, curve.b),
        [](const ContactGroup& p, const auto& objects) { return std::tuple(p.a, p.b) < objects; });
    for (std::uint32_t i = 0; i < curve.contact_count; ++i)
      curve_contacts[curve.first_contact + i] += group->first_contact;
  }
}

void FoundLists::list(DetectResult& result) const {
  result.object_pairs = pairs[0];
  result.groups = groups;
  result.contacts = contacts;
  result.contact_points = contact_points;
  result.continuous_groups = continuous_groups;
  result.continuous_contacts = continuous_contacts;
  result.proximity_groups = proximity_groups;
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
