#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <type_traits>

#include "supple/result.hpp"
#include "supple/result_lists.hpp"

namespace supple {

/// Equality of records, in which a NaN equals itself.
inline bool same_number(double p, double q) {
  return p == q || (p != p && q != q);
}
template <class Row>
bool same_row(const Row& p, const Row& q) {
  if constexpr (std::is_same_v<Row, NonFiniteVertex>) {
    return p.object == q.object && p.vertex == q.vertex && same_number(p.position.x, q.position.x) &&
           same_number(p.position.y, q.position.y) && same_number(p.position.z, q.position.z);
  } else {
    return p == q;
  }
}
inline bool same_row(const ContactGroup& p, const ContactGroup& q) {
  return p.a == q.a && p.b == q.b && p.first_contact == q.first_contact && p.contact_count == q.contact_count;
}

template <class Row>
void expect_same(const char* name, std::span<const Row> found, std::span<const Row> expected,
                 const std::string& where) {
  ASSERT_EQ(found.size(), expected.size()) << name << " " << where;
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_TRUE(same_row(found[i], expected[i])) << name << " " << i << " " << where;
}

inline void expect_same(const DetectResult& found, const DetectResult& expected, const std::string& where) {
  EXPECT_EQ(found.step, expected.step) << where;
  for_each_list([&]<class Row>(const ResultList<Row>& list, auto member) {
    expect_same<Row>(list.name, member(found), member(expected), where);
  });
  expect_same<ContactGroup>("groups", found.groups, expected.groups, where);
  expect_same<ContactGroup>("continuous_groups", found.continuous_groups, expected.continuous_groups, where);
  expect_same<ContactGroup>("proximity_groups", found.proximity_groups, expected.proximity_groups, where);
  expect_same<NonFiniteVertex>("non_finite", found.non_finite_vertices, expected.non_finite_vertices, where);
  expect_same<UntestedKind>("untested", found.untested, expected.untested, where);
  expect_same<ObjectPair>("volume stay", found.volume_events.stay, expected.volume_events.stay, where);
  expect_same<ObjectPair>("contact stay", found.contact_events.stay, expected.contact_events.stay, where);
}

}  // namespace supple
