#include "found_lists.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <tuple>

#include "core/sort_once.hpp"

namespace supple {
namespace {

/// The rows of another list to which the rows of a list refer.
struct Reference {
  struct Part {
    const FieldInfo* size;
    char side;  // of vertices
  };
  std::size_t list = 0;
  const FieldInfo* first = nullptr;
  std::vector<Part> parts;       // one after the other
  bool counts_contacts = false;  // the rows count those of all objects
};

/// By list.
const std::vector<std::vector<Reference>>& references_of_lists() {
  static const std::vector<std::vector<Reference>> all = [] {
    std::vector<std::vector<Reference>> ranges;
    for (const ListInfo& list : list_infos()) {
      std::vector<Reference>& of_list = ranges.emplace_back();
      for (const FieldInfo& first : list.record.fields) {
        if (first.role.names != Names::first_row || *list.record.name == 0) continue;
        Reference& range = of_list.emplace_back();
        range.list = place_of_list(first.role.list);
        range.first = &first;
        range.counts_contacts = list_infos()[range.list].record.fields[0].role.names == Names::first_row;
        for (const FieldInfo& size : list.record.fields) {
          if (size.role.names == Names::rows && std::string_view(size.role.list) == first.role.list)
            range.parts.push_back({&size, size.role.side});
        }
      }
    }
    return ranges;
  }();
  return all;
}

/// The records of the lists with the members alone that name objects and what belongs to them.
const std::vector<RecordInfo>& naming_records() {
  static const std::vector<RecordInfo> all = [] {
    std::vector<RecordInfo> records;
    for (const ListInfo& list : list_infos())
      std::erase_if(records.emplace_back(list.record).fields,
                    [](const FieldInfo& field) { return !is_name(field); });
    return records;
  }();
  return all;
}

/// Whether rows of another list refer to those of this one, so that these have their order.
bool is_referred_to(std::size_t list) {
  return std::ranges::any_of(references_of_lists(), [&](const auto& ranges) {
    return std::ranges::any_of(ranges, [&](const Reference& range) { return range.list == list; });
  });
}

void set_number(const FieldInfo& field, std::byte* row, std::uint32_t number) {
  std::memcpy(row + field.offset, &number, sizeof number);
}
std::uint32_t first_of(const Reference& range, const std::byte* row) {
  return static_cast<std::uint32_t>(number_of(*range.first, row));
}
std::size_t length_of(const Reference& range, const std::byte* row) {
  std::size_t length = 0;
  for (const auto& [field, side] : range.parts) length += number_of(*field, row);
  return length;
}

}  // namespace

bool is_before(const RecordInfo& record, const std::byte* p, const std::byte* q) {
  std::vector<std::uint64_t> key_p, key_q;
  add_key(record, p, key_p);
  add_key(record, q, key_q);
  return key_p < key_q;
}

/// Changes what counts the contacts of all objects, to count those of the objects of a row, or back.
void FoundLists::count_contacts(std::size_t list, std::size_t i, std::span<const ContactGroup> groups,
                                bool from_all) {
  for (const Reference& range : references_of_lists()[list]) {
    if (!range.counts_contacts) continue;
    const FieldInfo& value = list_infos()[range.list].record.fields[0];
    const std::byte* const of_row = row(list, i);
    const auto [a, b] = objects_of(naming_records()[list], of_row);
    const auto group = std::lower_bound(
        groups.begin(), groups.end(), std::tuple(a, b),
        [](const ContactGroup& p, const auto& objects) { return std::tuple(p.a, p.b) < objects; });
    for (std::size_t k = first_of(range, of_row), end = k + length_of(range, of_row); k < end; ++k) {
      std::byte* const contact = row(range.list, k);
      const auto number = static_cast<std::uint32_t>(number_of(value, contact));
      set_number(value, contact, from_all ? number - group->first_contact : number + group->first_contact);
    }
  }
}

void FoundLists::add(std::size_t list, std::size_t of_row, std::span<const ListRows> from,
                     std::span<const ContactGroup> groups, const Numbers& numbers) {
  const auto append = [&](std::size_t to, std::size_t first, std::size_t rows) {
    const std::size_t bytes = list_infos()[to].record.bytes;
    const std::byte* const begin = from[to].data + first * bytes;
    rows_[to].insert(rows_[to].end(), begin, begin + rows * bytes);
  };
  const std::uint32_t added = count(list);
  append(list, of_row, 1);
  for (const Reference& range : references_of_lists()[list]) {
    std::byte* const to = row(list, added);
    const std::uint32_t first = first_of(range, to);
    set_number(*range.first, to, count(range.list));
    if (from[range.list].count != 0) append(range.list, first, length_of(range, to));
  }
  count_contacts(list, added, groups, true);
  renumber(list, added, numbers);
}

/// Renumbers a row and all to which it refers.
void FoundLists::renumber(std::size_t list, std::size_t i, const Numbers& numbers) {
  const RecordInfo& record = naming_records()[list];
  std::byte* const of_row = row(list, i);
  const std::array<ObjectId, 2> objects = objects_of(record, of_row);
  for (const Reference& range : references_of_lists()[list]) {
    if (rows_[range.list].empty()) continue;  // contacts without points
    const RecordInfo& referred = naming_records()[range.list];
    std::size_t next = first_of(range, of_row);
    for (const auto& [length, side] : range.parts) {
      for (std::uint64_t k = number_of(*length, of_row); k > 0; --k)
        supple::renumber(referred, row(range.list, next++), objects, numbers, side);
    }
  }
  supple::renumber(record, of_row, objects, numbers);
}

void FoundLists::renumber(const Numbers& numbers) {
  for (std::size_t list = 0; list < rows_.size(); ++list) {
    if (is_referred_to(list)) continue;
    for (std::uint32_t i = 0; i < count(list); ++i) renumber(list, i, numbers);
  }
}

void FoundLists::clear() {
  for (auto& list : pairs) list.clear();
  non_finite_vertices.clear();
  for (auto& list : rows_) list.clear();
  is_sorted_ = true;
}

bool FoundLists::is_empty() const {
  const auto is_nothing = [](const auto& list) { return list.empty(); };
  return std::ranges::all_of(pairs, is_nothing) && non_finite_vertices.empty() &&
         std::ranges::all_of(rows_, is_nothing);
}

void FoundLists::write(Writer& to) const {
  for (const auto& list : pairs) to.put_all(list);
  to.put_all(non_finite_vertices);
  for (const auto& list : rows_) to.put_all(list);
}

void FoundLists::append(Reader& from) {
  std::vector<std::uint32_t> old;
  for (std::size_t list = 0; list < rows_.size(); ++list) old.push_back(count(list));
  for (auto& list : pairs) from.append_all(list);
  from.append_all(non_finite_vertices);
  for (auto& list : rows_) from.append_all(list);
  is_sorted_ = false;
  for (std::size_t list = 0; list < rows_.size(); ++list) {
    for (const Reference& range : references_of_lists()[list]) {
      for (std::uint32_t i = old[list]; i < count(list); ++i)
        set_number(*range.first, row(list, i), first_of(range, row(list, i)) + old[range.list]);
    }
  }
}

void FoundLists::sort() {
  for (std::vector<ObjectPair>& list : pairs) sort_once(list);
  // Parts of an object share the vertices on their borders.
  const auto key = [](const NonFiniteVertex& v) { return std::tuple(v.object, v.vertex); };
  std::ranges::sort(non_finite_vertices, {}, key);
  const auto same = std::ranges::unique(non_finite_vertices, {}, key);
  non_finite_vertices.erase(same.begin(), same.end());
  for (std::size_t list = 0; list < rows_.size(); ++list) {
    if (!is_sorted_ && !is_referred_to(list)) sort(list);
  }
}

/// Rows with equal keys keep their order: they are from one rank. Rows of one rank are in order.
void FoundLists::sort(std::size_t list) {
  const RecordInfo& record = list_infos()[list].record;
  std::vector<std::uint64_t> last, key, keys;
  for (std::uint32_t i = 0; i < count(list) && !(key < last); ++i) {
    last.swap(key);
    key.clear();
    add_key(record, row(list, i), key);
  }
  if (!(key < last)) return;
  for (std::uint32_t i = 0; i < count(list); ++i) add_key(record, row(list, i), keys);
  const std::size_t width = key.size();
  const auto key_of = [&](std::uint32_t i) { return std::span(keys).subspan(i * width, width); };
  const auto is_before_row = [&](std::uint32_t i, std::uint32_t k) {
    const auto p = key_of(i), q = key_of(k);
    const auto [at_p, at_q] = std::ranges::mismatch(p, q);
    return at_p == p.end() ? i < k : *at_p < *at_q;
  };
  std::vector<std::uint32_t> order(count(list));
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, is_before_row);
  std::vector<std::byte> sorted;
  sorted.reserve(rows_[list].size());
  for (const std::uint32_t i : order) sorted.insert(sorted.end(), row(list, i), row(list, i) + record.bytes);
  rows_[list].swap(sorted);
  for (const Reference& range : references_of_lists()[list]) {
    if (rows_[range.list].empty()) continue;
    const std::size_t bytes = list_infos()[range.list].record.bytes;
    std::vector<std::byte> ordered;
    ordered.reserve(rows_[range.list].size());
    for (std::uint32_t i = 0; i < count(list); ++i) {
      const std::byte* const from = row(range.list, first_of(range, row(list, i)));
      set_number(*range.first, row(list, i), static_cast<std::uint32_t>(ordered.size() / bytes));
      ordered.insert(ordered.end(), from, from + length_of(range, row(list, i)) * bytes);
    }
    rows_[range.list].swap(ordered);
  }
}

void FoundLists::list_groups(std::size_t list, std::vector<ContactGroup>& groups) {
  groups.clear();
  for (std::uint32_t i = 0; i < count(list); ++i) {
    const auto [a, b] = objects_of(naming_records()[list], row(list, i));
    if (groups.empty() || groups.back().a != a || groups.back().b != b) groups.push_back({a, b, i, 0});
    ++groups.back().contact_count;
  }
}

void FoundLists::list(DetectResult& result) {
  std::vector<ListRows> rows;
  for (std::size_t list = 0; list < rows_.size(); ++list) rows.push_back({rows_[list].data(), count(list)});
  set_rows(result, rows);
  for (std::size_t k = 0; k < contact_kinds.size(); ++k) {
    if (contact_kinds[k].groups == nullptr) continue;
    list_groups(place_of_answer(contact_kinds[k].kind), groups_[k]);
    result.*contact_kinds[k].groups = groups_[k];
  }
  for (std::size_t list = 0; list < rows_.size(); ++list) {
    if (std::ranges::none_of(references_of_lists()[list], &Reference::counts_contacts)) continue;
    for (std::uint32_t i = 0; i < count(list); ++i) count_contacts(list, i, result.groups, false);
  }
  result.object_pairs = pairs[of_volumes];
  result.non_finite_vertices = non_finite_vertices;
}

}  // namespace supple
