#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/contact.hpp"
#include "supple/result.hpp"

namespace supple {

/// Chooses the first contact of each vertex, edge and face from a list of continuous contacts. Keeps its
/// memory between steps.
class FirstContacts {
 public:
  /// Lists the first `max_contacts` contacts, in the order of `all`, that are the first of one of their
  /// elements, and changes the groups to them. O(n log n). Returns whether there are more.
  bool choose(std::span<const ContinuousContact> all, std::uint64_t max_contacts,
              std::vector<ContactGroup>& groups);
  std::span<const ContinuousContact> contacts() const { return contacts_; }
  /// Calls `visit(list)` for the list of the result.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    visit(contacts_);
  }
  /// Keeps those contacts of one pair of objects from `begin` on that are the first of one of their elements,
  /// in canonical order. O(n log n).
  void keep_first(std::vector<ContinuousContact>& found, std::size_t begin);

 private:
  /// One element of a contact. Sorted, the first contact of each element stands first.
  struct Entry {
    ObjectId object;
    FeatureKind kind{};
    std::array<std::uint32_t, 2> name{};
    double toi = 0;
    std::uint32_t contact = 0;

    bool is_of_same_element(const Entry& other) const {
      return object == other.object && kind == other.kind && name == other.name;
    }
    bool operator<(const Entry& other) const;
  };

  void find_first(std::span<const ContinuousContact> all);

  std::vector<Entry> entries_;
  std::vector<std::uint8_t> is_first_;
  std::vector<ContinuousContact> contacts_;
};

}  // namespace supple
