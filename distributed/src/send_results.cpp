// Chooses what a rank reports of what it found, and sends it to the ranks where the results are, with the
// user's numbers.
//
// Two clusters are tested by each rank whose region their boxes have in common. So several ranks can find a
// contact. It is reported by the rank whose region contains the lower corner of what the boxes of its two
// elements have in common: this point is in the boxes of all clusters that have these elements.

#include <algorithm>
#include <utility>

#include "answers/object_pairs.hpp"
#include "distributed_implementation.hpp"
#include "renumbered.hpp"

namespace supple {
namespace {

struct Box {
  Vec3d min, max;
};

void extend(Box& box, const Vec3d& p) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], p[axis]);
    box.max[axis] = std::max(box.max[axis], p[axis]);
  }
}

std::uint64_t hash_of(ObjectId a, ObjectId b) {
  std::uint64_t h = 0;
  for (const std::uint32_t part : {a.index, a.generation, b.index, b.generation}) {
    h = (h ^ part) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return h;
}

}  // namespace

/// The lowest corner of the box of an element of the world, grown for the search.
Vec3d DistributedScene::Implementation::lower_corner(ObjectId object, FeatureKind kind,
                                                     const std::array<std::uint32_t, 2>& element,
                                                     bool on_the_way) {
  const WorldObject& found = world()[object.index];
  const Placement& placement = found.placement();
  std::array<std::uint32_t, 3> vertices{element[0], element[1], element[1]};
  if (kind == FeatureKind::face) vertices = found.octree().user_triangle(element[0]);
  Box box{placement.position(vertices[0]), placement.position(vertices[0])};
  for (const std::uint32_t v : vertices) {
    extend(box, placement.position(v));
    if (on_the_way && placement.has_motion()) extend(box, placement.start_position(v));
  }
  const double growth = growth_of(found.options, nullptr, question_);
  return box.min - Vec3d{growth, growth, growth};
}

/// Whether this rank reports a pair of elements. `is_sure` says that it reports all pairs of the objects.
template <class Record>
bool DistributedScene::Implementation::is_mine(const Record& record) {
  Vec3d p, q;
  if constexpr (std::is_same_v<Record, Contact>) {
    p = lower_corner(record.object_a, FeatureKind::face, {record.triangle_a, 0}, false);
    q = lower_corner(record.object_b, FeatureKind::face, {record.triangle_b, 0}, false);
  } else if constexpr (std::is_same_v<Record, ContinuousContact>) {
    const auto [kind_a, kind_b] = feature_kinds(record.kind);
    p = lower_corner(record.object_a, kind_a, record.element_a, true);
    q = lower_corner(record.object_b, kind_b, record.element_b, true);
  } else {
    p = lower_corner(record.object_a, record.kind_a, record.element_a, false);
    q = lower_corner(record.object_b, record.kind_b, record.element_b, false);
  }
  return region_.contains(Vec3d{std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)});
}

/// Whether all that is found of two objects of the world is reported here: they are tested nowhere else.
bool DistributedScene::Implementation::reports_all(ObjectId a, ObjectId b) {
  if (by_objects_ || ranks.size() == 1) return true;
  const double growth = growth_of(world()[a.index].options, nullptr, question_);
  return region_.contains(grown(world()[a.index].box(), growth)) ||
         region_.contains(
             grown(world()[b.index].box(), growth_of(world()[b.index].options, nullptr, question_)));
}

int DistributedScene::Implementation::rank_of_pair(ObjectId a, ObjectId b) const {
  if (options.results == ResultPlacement::gathered) return 0;
  return static_cast<int>(hash_of(a, b) % static_cast<std::uint64_t>(ranks.size()));
}

/// Where the contacts of an object with others are; it has the user's number.
FoundLists& DistributedScene::Implementation::lists_of(ObjectId a) {
  switch (options.results) {
    case ResultPlacement::gathered:
      return outgoing_[0];
    case ResultPlacement::owner:
      return outgoing_[owners_.at(a)];
    case ResultPlacement::spread:
      break;
  }
  return outgoing_[ranks.rank()];
}

void DistributedScene::Implementation::send_pair(PairList list, ObjectId p, ObjectId q) {
  const auto [a, b] = std::minmax(p, q);
  if (a != b) outgoing_[rank_of_pair(a, b)].pairs[static_cast<std::size_t>(list)].push_back({a, b});
}

/// Adds the records of each group that this rank reports; `add(record, lists)` adds one.
template <class Record, class Add>
void DistributedScene::Implementation::send_groups(std::span<const ContactGroup> groups,
                                                   std::span<const Record> records, PairList events,
                                                   const Add& add) {
  for (const ContactGroup& group : groups) {
    const bool is_sure = reports_all(group.a, group.b);
    FoundLists* lists = nullptr;
    for (const Record& record : records.subspan(group.first_contact, group.contact_count)) {
      if (!is_sure && !is_mine(record)) continue;
      if (lists == nullptr) lists = &lists_of(user(group.a));
      add(renumbered(record, local_), *lists);
    }
    if (lists != nullptr) send_pair(events, user(group.a), user(group.b));
  }
}

void DistributedScene::Implementation::send_penetrations(const DetectResult& found) {
  const auto append = [&](std::span<const std::uint32_t> vertices, ObjectId object,
                          std::vector<std::uint32_t>& to) {
    for (const std::uint32_t v : vertices) to.push_back(local_.vertex(object, v));
  };
  const auto next = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  for (const PenetrationGroup& group : found.penetration_groups) {
    const ObjectId a = user(group.a), b = user(group.b);
    FoundLists& lists = lists_of(a);
    lists.penetration_groups.push_back({a, b, next(lists.penetrations), group.penetration_count,
                                        next(lists.vertices_on_surface), group.on_surface_count});
    for (const Penetration& depth : found.penetrations_of(group))
      lists.penetrations.push_back(renumbered(depth, local_));
    append(found.vertices_on_surface_of(group), group.a, lists.vertices_on_surface);
    if (group.penetration_count > 0) send_pair(PairList::inside, a, b);
  }
  for (const ContainedPart& contained : found.contained_parts) {
    const ContainedPart part = renumbered(contained, local_);
    lists_of(part.inner).contained_parts.push_back(part);
    send_pair(PairList::inside, part.inner, part.outer);
  }
  for (const IntersectionCurve& curve : found.curves) {
    const auto group = std::lower_bound(
        found.groups.begin(), found.groups.end(), std::pair(curve.a, curve.b),
        [](const ContactGroup& p, const auto& objects) { return std::pair(p.a, p.b) < objects; });
    FoundLists& lists = lists_of(user(curve.a));
    IntersectionCurve sent = curve;
    sent.a = user(curve.a);
    sent.b = user(curve.b);
    sent.first_contact = next(lists.curve_contacts);
    sent.first_point = next(lists.curve_points);
    sent.first_enclosed = next(lists.enclosed_vertices);
    lists.curves.push_back(sent);
    for (const std::uint32_t contact : found.contacts_of(curve))
      lists.curve_contacts.push_back(contact - group->first_contact);
    const std::span<const Vec3d> points = found.points_of(curve);
    lists.curve_points.insert(lists.curve_points.end(), points.begin(), points.end());
    append(found.enclosed_vertices_of(curve, ContactSide::a), curve.a, lists.enclosed_vertices);
    append(found.enclosed_vertices_of(curve, ContactSide::b), curve.b, lists.enclosed_vertices);
  }
}

/// The last result is no longer valid: this one takes its memory.
void DistributedScene::Implementation::clear_lists() {
  std::swap(lists_, outgoing_[ranks.rank()]);
  for (auto& [rank, lists] : outgoing_) lists.clear();
}

/// Fills the lists for each rank.
void DistributedScene::Implementation::send_results() {
  DetectResult found;
  detection_.list(found);
  clear_lists();
  send_groups(found.groups, found.contacts, PairList::contacts, [&](Contact contact, FoundLists& lists) {
    const std::span<const ContactPoint> points = found.points_of(contact);
    contact.first_point = static_cast<std::uint32_t>(lists.contact_points.size());
    lists.contacts.push_back(contact);
    lists.contact_points.insert(lists.contact_points.end(), points.begin(), points.end());
  });
  send_groups(found.continuous_groups, found.continuous_contacts, PairList::contacts,
              [](const ContinuousContact& c, FoundLists& lists) { lists.continuous_contacts.push_back(c); });
  send_groups(found.proximity_groups, found.proximity_pairs, PairList::margins,
              [](const ProximityPair& p, FoundLists& lists) { lists.proximity_pairs.push_back(p); });
  send_penetrations(found);
  for (const auto& [a, b] : object_pairs_) send_pair(PairList::volumes, a, b);
  for (const auto& [id, object] : homes_) {
    FoundLists& lists = outgoing_[options.results == ResultPlacement::gathered ? 0 : object.first_home];
    object.list_non_finite(question_.shapes(), lists.non_finite_vertices);
  }
}

/// Sends what this rank found to where the results are, and takes what is here.
void DistributedScene::Implementation::send_lists() {
  outbox_.clear();
  ranks.together([&] {
    for (const auto& [rank, lists] : outgoing_) {
      if (rank == ranks.rank() || lists.is_empty()) continue;
      Writer to = outbox_.to(rank);
      lists.write(to);
    }
    std::swap(lists_, outgoing_[ranks.rank()]);
  });
  ranks.exchange(outbox_, inbox_);
  ranks.together([&] {
    inbox_.for_each([&](Reader& from, int) { lists_.append(from); });
    lists_.sort();
  });
  release_messages();
}

void DistributedScene::Implementation::release_messages() {
  outbox_.release();
  inbox_.release();
  ranks.release();
}

}  // namespace supple
