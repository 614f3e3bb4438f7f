#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bytes.hpp"
#include "renumbered.hpp"
#include "scene/pair_cache.hpp"
#include "supple/record_info.hpp"
#include "supple/result.hpp"

namespace supple {

/// Lists of pairs of different objects whose changes are events: those with volumes that overlap, then those
/// with contacts of a kind.
inline constexpr std::size_t of_volumes = 0, pair_lists = 1 + events_of_kinds;
constexpr std::size_t pair_list_of(const ContactKindInfo& kind) {
  return 1 + place_of_events(kind);
}

/// The lists of a result, with memory of their own and the user's numbers. `list_infos` says what a row is
/// and to which rows of other lists it refers; a list of rows to which others refer has the order of these.
class FoundLists {
 public:
  FoundLists() : rows_(list_infos().size()) {}

  std::array<std::vector<ObjectPair>, pair_lists> pairs;
  std::vector<NonFiniteVertex> non_finite_vertices;

  /// Adds a row of a list, and all to which it refers, with other numbers. `from` are the rows of a result,
  /// whose groups of contacts are `groups`. What counts contacts, then counts from the first of the objects.
  void add(std::size_t list, std::size_t row, std::span<const ListRows> from,
           std::span<const ContactGroup> groups, const Numbers& numbers);
  void renumber(const Numbers& numbers);
  void clear();
  bool is_empty() const;
  void write(Writer& to) const;
  /// Adds the lists that `write` wrote.
  void append(Reader& from);
  /// Sorts all lists in canonical order.
  void sort();
  /// Lists the groups of the contacts, and adds spans of all lists. What counts contacts then counts all.
  void list(DetectResult& result);

 private:
  std::byte* row(std::size_t list, std::size_t i) {
    return rows_[list].data() + i * infos_[list].record.bytes;
  }
  std::uint32_t count(std::size_t list) const {
    return static_cast<std::uint32_t>(rows_[list].size() / infos_[list].record.bytes);
  }
  void renumber(std::size_t list, std::size_t i, const Numbers& numbers);
  void sort(std::size_t list);
  void list_groups(std::size_t list, std::vector<ContactGroup>& groups);
  void count_contacts(std::size_t list, std::size_t i, std::span<const ContactGroup> groups, bool from_all);

  const ListInfo* infos_ = list_infos().data();
  std::vector<std::vector<std::byte>> rows_;  // by list
  bool is_sorted_ = true;                     // the rows are those of one rank, in order
  std::array<std::vector<ContactGroup>, contact_kinds.size()> groups_;
};

/// Whether a row comes before another one in canonical order: by the members of its key.
bool is_before(const RecordInfo& record, const std::byte* p, const std::byte* q);

}  // namespace supple
