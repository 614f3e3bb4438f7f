#include "answers/first_contacts.hpp"

#include <algorithm>
#include <tuple>

namespace supple {

bool FirstContacts::Entry::operator<(const Entry& other) const {
  return std::tie(object, kind, name, toi, contact) <
         std::tie(other.object, other.kind, other.name, other.toi, other.contact);
}

/// Marks the contacts that are the first of one of their elements. `all` are in canonical order.
void FirstContacts::find_first(std::span<const ContinuousContact> all) {
  entries_.clear();
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const ContinuousContact& contact = all[i];
    const auto [kind_a, kind_b] = feature_kinds(contact.kind);
    entries_.push_back({contact.object_a, kind_a, contact.element_a, contact.toi, i});
    entries_.push_back({contact.object_b, kind_b, contact.element_b, contact.toi, i});
  }
  std::sort(entries_.begin(), entries_.end());
  is_first_.assign(all.size(), 0);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (i == 0 || !entries_[i].is_of_same_element(entries_[i - 1])) is_first_[entries_[i].contact] = 1;
  }
}

void FirstContacts::keep_first(std::vector<ContinuousContact>& found, std::size_t begin) {
  const auto first = found.begin() + static_cast<std::ptrdiff_t>(begin);
  std::sort(first, found.end(), [](const ContinuousContact& p, const ContinuousContact& q) {
    return std::tie(p.kind, p.element_a, p.element_b) < std::tie(q.kind, q.element_a, q.element_b);
  });
  find_first({first, found.end()});
  auto kept = first;
  for (std::size_t i = 0; i < is_first_.size(); ++i) {
    if (is_first_[i] != 0) *kept++ = found[begin + i];
  }
  found.erase(kept, found.end());
}

bool FirstContacts::choose(std::span<const ContinuousContact> all, std::uint64_t max_contacts,
                           std::vector<ContactGroup>& groups) {
  find_first(all);
  contacts_.clear();
  bool are_more = false;
  for (ContactGroup& group : groups) {
    const std::uint32_t first = group.first_contact, end = first + group.contact_count;
    group.first_contact = static_cast<std::uint32_t>(contacts_.size());
    for (std::uint32_t i = first; i < end; ++i) {
      if (is_first_[i] == 0) continue;
      are_more = contacts_.size() >= max_contacts;
      if (!are_more) contacts_.push_back(all[i]);
    }
    group.contact_count = static_cast<std::uint32_t>(contacts_.size()) - group.first_contact;
  }
  std::erase_if(groups, [](const ContactGroup& group) { return group.contact_count == 0; });
  return are_more;
}

}  // namespace supple
