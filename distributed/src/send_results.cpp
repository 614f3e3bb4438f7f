// Chooses what a rank reports of what it found, and sends it to the ranks where the results are, with the
// user's numbers.
//
// Two clusters are tested by each rank whose region their boxes have in common. So several ranks can find a
// contact. It is reported by the rank whose region contains the lower corner of what the boxes of its two
// elements have in common: this point is in the boxes of all clusters that have these elements.

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "answers/object_pairs.hpp"
#include "distributed_implementation.hpp"

namespace supple {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

/// Whether this rank reports a row with an element or a triangle of two objects.
bool DistributedScene::Implementation::is_mine(const ListInfo& list, const std::byte* row) {
  const std::array<ObjectId, 2> objects = objects_of(list.record, row);
  Vec3d corner{-infinity, -infinity, -infinity};
  for (const FieldInfo& field : list.record.fields) {
    const auto [names, side] = std::pair(field.role.names, field.role.side);
    if (names != Names::triangle && names != Names::element) continue;
    std::array<std::uint32_t, 2> element{};
    std::memcpy(element.data(), row + field.offset, field.bytes());
    const FeatureKind kind =
        names == Names::triangle ? FeatureKind::face : list.record.kind_of_element(row, side);
    const Vec3d lowest = lower_corner(objects[side == 'b' ? 1 : 0], kind, element,
                                      info_of(list.answers).shape == SearchedShape::paths);
    for (int axis = 0; axis < 3; ++axis) corner[axis] = std::max(corner[axis], lowest[axis]);
  }
  return region_.contains(corner);
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

void DistributedScene::Implementation::send_pair(std::size_t list, ObjectId p, ObjectId q) {
  const auto [a, b] = std::minmax(p, q);
  if (a != b) outgoing_[rank_of_pair(a, b)].pairs[list].push_back({a, b});
}

/// Adds the rows of each group that this rank reports.
void DistributedScene::Implementation::send_groups(const DetectResult& found, const ContactKindInfo& kind) {
  const std::vector<ListRows> rows = rows_of(found);
  const std::size_t place = place_of_answer(kind.kind);
  const ListInfo& list = list_infos()[place];
  for (const ContactGroup& group : found.*kind.groups) {
    const bool is_sure = reports_all(group.a, group.b);
    FoundLists* lists = nullptr;
    for (std::size_t i = group.first_contact; i < group.first_contact + group.contact_count; ++i) {
      if (!is_sure && !is_mine(list, rows[place].data + i * list.record.bytes)) continue;
      if (lists == nullptr) lists = &lists_of(user(group.a));
      lists->add(place, i, rows, found.groups, local_);
    }
    if (lists != nullptr) send_pair(pair_list_of(kind), user(group.a), user(group.b));
  }
}

/// Adds all rows of a list: the objects are tested on no other rank.
void DistributedScene::Implementation::send_all(const DetectResult& found, const char* name) {
  const std::vector<ListRows> rows = rows_of(found);
  const std::size_t place = place_of_list(name);
  const RecordInfo& record = list_infos()[place].record;
  for (std::size_t i = 0; i < rows[place].count; ++i) {
    const auto [a, b] = objects_of(record, rows[place].data + i * record.bytes);
    lists_of(user(a)).add(place, i, rows, found.groups, local_);
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
  for (const ContactKindInfo& kind : contact_kinds) {
    if (kind.groups != nullptr) send_groups(found, kind);
  }
  for (const char* const list : {"penetration_groups", "contained_parts", "curves"}) send_all(found, list);
  for (const PenetrationGroup& group : found.penetration_groups) {
    if (group.penetration_count > 0)
      send_pair(pair_list_of(info_of(ContactKinds::penetration)), user(group.a), user(group.b));
  }
  for (const auto& [a, b] : object_pairs_) send_pair(of_volumes, a, b);
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
