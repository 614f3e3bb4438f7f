#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "supple/difference_descriptions.hpp"
#include "supple/error.hpp"
#include "supple/query_descriptions.hpp"
#include "supple/record_info.hpp"
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

/// A record with a member of each form.
struct Toy {
  ObjectId owner;
  std::array<std::uint32_t, 2> edge{};
  FeatureKind kind = FeatureKind::edge;
  bool is_open = true;
  std::uint64_t number = 1;
  Vec3d place{};
  Feature feature;
};

}  // namespace supple::records_test

namespace supple {

template <>
struct Description<records_test::Toy> : RecordDescription<records_test::Toy> {
  static constexpr const char* name = "Toy";
  static constexpr void fields(auto&& field) {
    field("owner", &Row::owner, "Owner", role::object('a'));
    field("edge", &Row::edge, "Edge", role::key(Names::element, 'a'));
    field("kind", &Row::kind, "Kind");
    field("is_open", &Row::is_open, "Whether it is open");
    field("number", &Row::number, "Number", {}, "pieces");
    field("place", &Row::place, "Place", role::rounded, "length");
    field("feature", &Row::feature, "Feature");
  }
};

}  // namespace supple

namespace supple::records_test {

TEST(RecordInfo, HasTheMembersOfTheRecord) {
  const RecordInfo record = record_info<Toy>();
  EXPECT_EQ(record.bytes, sizeof(Toy));
  ASSERT_EQ(record.fields.size(), 7u);
  const auto expect = [&](std::size_t i, const char* name, ScalarType scalar, std::size_t count,
                          std::size_t offset) {
    const FieldInfo& field = record.fields[i];
    EXPECT_STREQ(field.name, name);
    EXPECT_EQ(field.scalar, scalar) << name;
    EXPECT_EQ(field.count, count) << name;
    EXPECT_EQ(field.offset, offset) << name;
  };
  expect(0, "owner", ScalarType::uint32, 2, offsetof(Toy, owner));
  expect(1, "edge", ScalarType::uint32, 2, offsetof(Toy, edge));
  expect(2, "kind", ScalarType::uint8, 1, offsetof(Toy, kind));
  expect(3, "is_open", ScalarType::boolean, 1, offsetof(Toy, is_open));
  expect(4, "number", ScalarType::uint64, 1, offsetof(Toy, number));
  expect(5, "place", ScalarType::float64, 3, offsetof(Toy, place));
  expect(6, "feature", ScalarType::uint8, 2, offsetof(Toy, feature));
  EXPECT_EQ(record.fields[0].kind, FieldInfo::Kind::object);
  EXPECT_EQ(record.fields[6].kind, FieldInfo::Kind::feature);
  EXPECT_STREQ(record.fields[2].words[1], "edge");
  EXPECT_STREQ(record.fields[4].unit, "pieces");

  const Toy toy{{3, 4}, {5, 6}, FeatureKind::edge, true, 7, {1, 2, -0.5}, {FeatureKind::edge, 2}};
  const auto* const row = reinterpret_cast<const std::byte*>(&toy);
  EXPECT_EQ(number_of(record.fields[1], row, 1), 6u);
  EXPECT_EQ(number_of(record.fields[3], row), 1u);
  EXPECT_EQ(number_of(record.fields[4], row), 7u);
  EXPECT_EQ(real_number(record.fields[5], row, 2), -0.5);
  EXPECT_THROW(number_of(record.fields[5], row), Error);
  std::vector<std::uint64_t> key;
  add_key(record, row, key);
  EXPECT_EQ(key, (std::vector<std::uint64_t>{3, 4, 5, 6}));
}

/// Members of records in an array have the place of their record.
TEST(RecordInfo, HasTheMembersOfRecordsInRecords) {
  const RecordInfo record = record_info<TriangleIntersection>();
  int places = -1;
  for (const FieldInfo& field : record.fields) places = std::max(places, field.place);
  EXPECT_EQ(places, 5);
}

TEST(RecordInfo, ListsHaveTheRowsOfTheResult) {
  DetectResult result, same;
  const std::vector<Contact> contacts(3);
  const std::vector<std::uint32_t> vertices{4, 5};
  result.contacts = contacts;
  result.enclosed_vertices = vertices;
  const std::vector<ListRows> rows = rows_of(result);
  ASSERT_EQ(rows.size(), list_infos().size());
  EXPECT_EQ(rows[place_of_list("contacts")].count, 3u);
  const ListInfo& list = list_infos()[place_of_list("enclosed_vertices")];
  const ListRows& of_list = rows[place_of_list("enclosed_vertices")];
  EXPECT_EQ(number_of(list.record.fields[0], of_list.data + list.record.bytes), 5u);
  EXPECT_THROW(place_of_list("lists"), Error);
  set_rows(same, rows);
  EXPECT_EQ(same.contacts.data(), contacts.data());
  EXPECT_EQ(same.contacts.size(), 3u);
  EXPECT_EQ(same.enclosed_vertices.data(), vertices.data());
}

}  // namespace supple::records_test
