// Sends what a rank has found to the ranks where the results are, with the user's numbers.

#include <algorithm>
#include <utility>

#include "distributed_implementation.hpp"

namespace supple {
namespace {

std::uint64_t mixed(std::uint64_t h, std::uint64_t value) {
  h = (h ^ value) * 0x9e3779b97f4a7c15u;
  return h ^ (h >> 29);
}
std::uint64_t hash_of(ObjectId a, ObjectId b) {
  std::uint64_t h = 0;
  for (const std::uint32_t part : {a.index, a.generation, b.index, b.generation}) h = mixed(h, part);
  return h;
}

}  // namespace

int DistributedScene::Implementation::rank_of_pair(ObjectId a, ObjectId b) const {
  if (options.results == ResultPlacement::gathered) return 0;
  return static_cast<int>(hash_of(a, b) % static_cast<std::uint64_t>(ranks.size()));
}

/// The objects have the user's numbers.
int DistributedScene::Implementation::rank_of_record(ObjectId a, ObjectId b, std::uint32_t element) const {
  if (options.results == ResultPlacement::owner) return owners_.at(a);
  if (options.results == ResultPlacement::gathered || by_objects_) return rank_of_pair(a, b);
  return static_cast<int>(mixed(hash_of(a, b), element) % static_cast<std::uint64_t>(ranks.size()));
}

Contact DistributedScene::Implementation::named(Contact contact) const {
  contact.triangle_a = local_.user_face(contact.object_a.index, contact.triangle_a);
  contact.triangle_b = local_.user_face(contact.object_b.index, contact.triangle_b);
  contact.object_a = user(contact.object_a);
  contact.object_b = user(contact.object_b);
  return contact;
}

std::array<std::uint32_t, 2> DistributedScene::Implementation::named(
    ObjectId object, FeatureKind kind, const std::array<std::uint32_t, 2>& element) const {
  std::array<std::uint32_t, 2> found = element;
  for (std::uint32_t& number : found) {
    number = kind == FeatureKind::face ? local_.user_face(object.index, number)
                                       : local_.user_vertex(object.index, number);
  }
  return found;
}

ContinuousContact DistributedScene::Implementation::named(ContinuousContact contact) const {
  const auto [kind_a, kind_b] = feature_kinds(contact.kind);
  contact.element_a = named(contact.object_a, kind_a, contact.element_a);
  contact.element_b = named(contact.object_b, kind_b, contact.element_b);
  contact.object_a = user(contact.object_a);
  contact.object_b = user(contact.object_b);
  return contact;
}

ProximityPair DistributedScene::Implementation::named(ProximityPair pair) const {
  pair.element_a = named(pair.object_a, pair.kind_a, pair.element_a);
  pair.element_b = named(pair.object_b, pair.kind_b, pair.element_b);
  pair.object_a = user(pair.object_a);
  pair.object_b = user(pair.object_b);
  return pair;
}

std::vector<std::uint32_t> DistributedScene::Implementation::user_vertices(
    ObjectId object, std::span<const std::uint32_t> vertices) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t v : vertices) found.push_back(local_.user_vertex(object.index, v));
  return found;
}

void DistributedScene::Implementation::send_penetrations(const DetectResult& found) {
  for (const PenetrationGroup& group : found.penetration_groups) {
    PenetrationGroup named_group = group;
    named_group.a = user(group.a);
    named_group.b = user(group.b);
    std::vector<Penetration> depths;
    for (Penetration depth : found.penetrations_of(group)) {
      depth.vertex = local_.user_vertex(group.a.index, depth.vertex);
      depth.triangle = local_.user_face(group.b.index, depth.triangle);
      depth.object_a = named_group.a;
      depth.object_b = named_group.b;
      depths.push_back(depth);
    }
    Writer to = outbox_.to(rank_of_record(named_group.a, named_group.b, 0));
    write_record(named_group, depths, user_vertices(group.a, found.vertices_on_surface_of(group)), to);
  }
  for (ContainedPart part : found.contained_parts) {
    part.vertex = local_.user_vertex(part.inner.index, part.vertex);
    part.inner = user(part.inner);
    part.outer = user(part.outer);
    Writer to = outbox_.to(rank_of_record(part.inner, part.outer, 0));
    write_record(part, to);
  }
  for (const IntersectionCurve& curve : found.curves) {
    const auto group = std::lower_bound(
        found.groups.begin(), found.groups.end(), std::pair(curve.a, curve.b),
        [](const ContactGroup& p, const auto& objects) { return std::pair(p.a, p.b) < objects; });
    std::vector<std::uint32_t> contacts;
    for (const std::uint32_t contact : found.contacts_of(curve))
      contacts.push_back(contact - group->first_contact);
    std::vector<std::uint32_t> enclosed =
        user_vertices(curve.a, found.enclosed_vertices_of(curve, ContactSide::a));
    const std::vector<std::uint32_t> of_b =
        user_vertices(curve.b, found.enclosed_vertices_of(curve, ContactSide::b));
    enclosed.insert(enclosed.end(), of_b.begin(), of_b.end());
    IntersectionCurve named_curve = curve;
    named_curve.a = user(curve.a);
    named_curve.b = user(curve.b);
    Writer to = outbox_.to(rank_of_record(named_curve.a, named_curve.b, 0));
    write_record(found, named_curve, contacts, enclosed, to);
  }
}

/// Sends what this rank found to where the results are.
void DistributedScene::Implementation::send_results(const Question& question) {
  DetectResult found;
  detection_.list(found);
  outbox_.clear();
  const auto send_all = [&](const auto& records, const auto& element) {
    for (const auto& record : records) {
      const auto renamed = named(record);
      Writer to = outbox_.to(rank_of_record(renamed.object_a, renamed.object_b, element(renamed)));
      write_record(found, renamed, to);
    }
  };
  send_all(found.contacts, [](const Contact& c) { return c.triangle_a; });
  send_all(found.continuous_contacts, [](const ContinuousContact& c) { return c.element_a[0]; });
  send_all(found.proximity_pairs, [](const ProximityPair& p) { return p.element_a[0]; });
  send_penetrations(found);
  const auto send_pair = [&](PairList list, ObjectId p, ObjectId q) {
    const auto [a, b] = std::minmax(p, q);
    if (a == b) return;
    Writer to = outbox_.to(rank_of_pair(a, b));
    write_pair(list, {a, b}, to);
  };
  for (const auto& [a, b] : object_pairs_) send_pair(PairList::volumes, a, b);
  for (const auto groups : {found.groups, found.continuous_groups}) {
    for (const ContactGroup& group : groups) send_pair(PairList::contacts, user(group.a), user(group.b));
  }
  for (const ContactGroup& group : found.proximity_groups)
    send_pair(PairList::margins, user(group.a), user(group.b));
  for (const PenetrationGroup& group : found.penetration_groups) {
    if (group.penetration_count > 0) send_pair(PairList::inside, user(group.a), user(group.b));
  }
  for (const ContainedPart& part : found.contained_parts)
    send_pair(PairList::inside, user(part.inner), user(part.outer));
  std::vector<NonFiniteVertex> vertices;
  for (const auto& [id, object] : homes_) {
    object.list_non_finite(question.shapes(), vertices);
    Writer to = outbox_.to(options.results == ResultPlacement::gathered ? 0 : object.first_home);
    for (const NonFiniteVertex& vertex : vertices) write_record(vertex, to);
    vertices.clear();
  }
}

}  // namespace supple
