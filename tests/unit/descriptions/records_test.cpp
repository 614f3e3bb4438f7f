#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "supple/difference_descriptions.hpp"
#include "supple/query_descriptions.hpp"
#include "supple/result_lists.hpp"
#include "supple/verify.hpp"

namespace supple::records_test {

/// Initialises a member of any type.
struct Anything {
  template <class Value>
  operator Value() const;  // NOLINT: implicit, and not defined
};

template <class Record, std::size_t... I>
constexpr bool has_members(std::index_sequence<I...>) {
  return requires {
    Record{(static_cast<void>(I), Anything{})...};
  };
}

/// The number of members of a record: as many values as can initialise it.
template <class Record, std::size_t Count = 1>
constexpr std::size_t count_members() {
  if constexpr (has_members<Record>(std::make_index_sequence<Count + 1>{}))
    return count_members<Record, Count + 1>();
  else
    return Count;
}

struct Three {
  int a = 0;
  std::array<double, 2> b{};
  Vec3d c{};
};
static_assert(count_members<Three>() == 3);

/// The names of the lists of a result.
std::set<std::string> list_names() {
  std::set<std::string> names;
  for_each_list([&](const auto& list, auto) { EXPECT_TRUE(names.insert(list.name).second) << list.name; });
  return names;
}

template <Described Record>
void expect_whole_description() {
  const std::string name = Description<Record>::name;
  const std::set<std::string> lists = list_names();
  std::size_t count = 0;
  bool is_in_key = true;
  std::set<std::string> keys;
  for_each_field<Record>([&]<class Value>(const Field<Record, Value>& field) {
    ++count;
    const std::string at = name + "::" + field.key;
    EXPECT_TRUE(keys.insert(field.key).second) << at;
    const std::string_view doc = field.doc;
    EXPECT_TRUE(!doc.empty() && doc.back() != '.') << at;
    EXPECT_TRUE(is_in_key || !field.role.is_key) << at << ": the members of the key are the first ones";
    is_in_key = field.role.is_key;
    EXPECT_TRUE(*field.role.list == 0 || lists.contains(field.role.list)) << at << ": " << field.role.list;
    EXPECT_EQ((field.role.names == Names::object), (std::is_same_v<Value, ObjectId>)) << at;
    if (field.role.names == Names::object || field.role.names == Names::element ||
        field.role.names == Names::triangle || field.role.names == Names::vertex) {
      EXPECT_TRUE(field.role.side == 'a' || field.role.side == 'b') << at;
    }
    if (std::is_same_v<Value, std::array<double, 3>>) {
      EXPECT_EQ(field.role.names, Names::weights) << at;
    }
  });
  EXPECT_EQ(count, count_members<Record>()) << name << " has a member without a description";
}

TEST(RecordDescriptions, HaveEveryMember) {
  for_each_list([]<class Row>(const ResultList<Row>& list, auto) {
    EXPECT_NE(std::string_view(list.doc), "") << list.name;
    if constexpr (Described<Row>)
      expect_whole_description<Row>();
    else
      EXPECT_NE(std::string_view(list.value), "") << list.name;
  });
  expect_whole_description<EndedManifold>();
  expect_whole_description<NonFiniteVertex>();
  expect_whole_description<UntestedKind>();
  expect_whole_description<ContactGroup>();
  expect_whole_description<Difference>();
  expect_whole_description<ContinuousDifference>();
  expect_whole_description<ProximityDifference>();
  expect_whole_description<PenetrationDifference>();
  expect_whole_description<ClosestPoint>();
  expect_whole_description<RayHit>();
  expect_whole_description<ListedRayHit>();
  expect_whole_description<Overlap>();
  expect_whole_description<LimitingPair>();
  expect_whole_description<ElementDistance>();
  expect_whole_description<TriangleIntersection>();
  expect_whole_description<Impact>();
}

}  // namespace supple::records_test
