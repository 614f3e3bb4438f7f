#include "supple/description.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "members.hpp"
#include "other_values.hpp"
#include "supple/difference_descriptions.hpp"
#include "supple/error.hpp"

namespace supple::description_test {

template <class Struct>
class EachStructure : public testing::Test {};
using Structures =
    testing::Types<ImpactOptions, ObjectOctreeOptions, SceneOctreeOptions, ComparisonOptions, ObjectOptions,
                   SceneOptions, StepOptions, BroadPhaseOptions, MassSpringOptions, MassSpringMotion::Handle,
                   MassSpringMotion, RigidMotion, WaveMotion, ContactResponse, SimulationOptions, StepStats,
                   BroadPhaseStats, OctreeStatistics, PolygonCounts>;
TYPED_TEST_SUITE(EachStructure, Structures);

TYPED_TEST(EachStructure, DescribesEveryMemberInOrder) {
  TypeParam values{};
  std::vector<const void*> members, described;
  std::apply([&](const auto&... member) { (members.push_back(&member), ...); }, members_of(values));
  for_each_field<TypeParam>([&](const auto& field) {
    described.push_back(&(values.*field.member));
    EXPECT_GT(std::string_view(field.doc).size(), 5u) << field.name;
    EXPECT_NE(std::string_view(field.doc).back(), '.') << field.name;
  });
  EXPECT_EQ(described, members);
}

TYPED_TEST(EachStructure, AllowsItsDefaultsAndRefusesWhatIsOutOfRange) {
  EXPECT_NO_THROW(check(TypeParam{}));
  const auto expect_refused = [](const auto& field, TypeParam values) {
    try {
      check(values, "here");
      ADD_FAILURE() << field.name << " was taken";
    } catch (const Error& error) {
      const std::string start =
          std::string("here: ") + Description<TypeParam>::name + "::" + field.name + " is ";
      EXPECT_EQ(std::string(error.what()).rfind(start, 0), 0u) << error.what();
    }
  };
  for_each_field<TypeParam>([&](const auto& field) {
    TypeParam values{};
    auto& value = values.*field.member;
    using Value = std::remove_cvref_t<decltype(value)>;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if constexpr (Worded<Value>) {
      value = static_cast<Value>(words<Value>.size());
      expect_refused(field, values);
    } else if constexpr (std::is_same_v<Value, double>) {
      std::vector<double> wrong{std::numeric_limits<double>::quiet_NaN(), -infinity};
      if (!field.range.includes_infinity) wrong.push_back(infinity);
      if (field.range.lowest > -infinity) wrong.push_back(field.range.lowest - 1);
      if (field.range.excludes_lowest) wrong.push_back(field.range.lowest);
      if (field.range.highest < infinity) wrong.push_back(field.range.highest + 1);
      for (const double number : wrong) {
        value = number;
        expect_refused(field, values);
      }
    } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
      std::vector<double> wrong;
      if (field.range.lowest > 0 && !field.range.allows(std::uint32_t(field.range.lowest - 1)))
        wrong.push_back(field.range.lowest - 1);
      if (field.range.highest < 0xffffffff) wrong.push_back(field.range.highest + 1);
      if (field.range.powers_of_two) wrong.push_back(field.range.lowest + 1);
      for (const double number : wrong) {
        value = static_cast<std::uint32_t>(number);
        expect_refused(field, values);
      }
    } else if constexpr (std::is_same_v<Value, Vec3d>) {
      value.y = infinity;
      expect_refused(field, values);
    }
  });
}

TEST(Descriptions, KeysThatOccurTogetherDiffer) {
  std::set<std::string> keys;
  const auto add = [&](const auto& values) {
    for_each_leaf(
        [&](const auto& field, const auto&) { EXPECT_TRUE(keys.insert(field.key).second) << field.key; },
        values);
  };
  add(SceneOptions{});  // both are options of the command line
  // The command line has only the separation of the scene. Elsewhere, objects have tables of their own.
  EXPECT_EQ(keys.erase("min_separation"), 1u);
  add(ObjectOptions{});
  keys.clear();
  add(MassSpringMotion{});
}

/// The name of an enumerator as spelled by the compiler; empty for a value without one, such as `(Enum)3`.
template <class Enum, Enum value>
constexpr std::string_view spelling() {
  const std::string_view function = __PRETTY_FUNCTION__;
  const std::size_t start = function.find("value = ") + 8;
  const std::string_view name = function.substr(start, function.find_first_of(";]", start) - start);
  const std::size_t colon = name.rfind("::");
  return name.find('(') != std::string_view::npos || colon == std::string_view::npos ? ""
                                                                                     : name.substr(colon + 2);
}

template <class Enum, std::size_t... Values>
void expect_words(std::index_sequence<Values...>) {
  const std::string_view enumerators[] = {spelling<Enum, static_cast<Enum>(Values)>()...};
  for (std::size_t i = 0; i + 1 < sizeof...(Values); ++i) EXPECT_EQ(words<Enum>[i], enumerators[i]);
  EXPECT_EQ(enumerators[sizeof...(Values) - 1], "") << "there is an enumerator without a word";
}

TEST(Descriptions, WordsAreTheNamesOfTheEnumerators) {
  const auto expect = []<class Enum>(Enum) {
    expect_words<Enum>(std::make_index_sequence<words<Enum>.size() + 1>());
    for (const char* word : words<Enum>) EXPECT_STREQ(word_of(*value_of_word<Enum>(word)), word);
    EXPECT_FALSE(value_of_word<Enum>("nothing"));
  };
  expect(BoundingVolume{});
  expect(SphereFit{});
  expect(ObjectOctreeBuild{});
  expect(BroadPhaseMethod{});
  expect(RegionSphereTest{});
  expect(Integrator{});
  expect(IntersectionKind{});
  expect(ImpactCertainty{});
  expect(ContinuousDifference::Fault{});
  expect(PairStage{});
}

TEST(Descriptions, RangesSayWhatTheyAllow) {
  EXPECT_EQ(text_of(ValueRange::from(0, 32), true), "a whole number from 0 to 32");
  EXPECT_EQ(text_of(ValueRange::from(1, 0xffffffff), true), "a whole number from 1 to 4294967295");
  EXPECT_EQ(text_of(ValueRange::from(0), false), "a finite number from 0 up");
  EXPECT_EQ(text_of(ValueRange::above(0), false), "a finite number above 0");
  EXPECT_EQ(text_of(ValueRange::above(0).or_infinity(), false),
            "a finite number above 0, or infinity for none");
  EXPECT_EQ(text_of(ValueRange::from(0, 1), false), "a number from 0 to 1");
  EXPECT_EQ(text_of(ValueRange{}, false), "a finite number");
  EXPECT_EQ(text_of(ValueRange::from(2, 8).only_powers_of_two(), true), "2, 4 or 8");
}

TEST(Descriptions, OtherValuesDifferFromTheDefaultsAndAreAllowed) {
  const auto expect = []<class Struct>(const Struct& defaults) {
    const Struct others = other_values<Struct>();
    EXPECT_EQ(differences_of(defaults, others).size(), count_leaves<Struct>());
    EXPECT_NO_THROW(check(others));
  };
  expect(SceneOptions{});
  expect(ObjectOptions{});
  expect(SimulationOptions{});
  expect(MassSpringMotion{});
  expect(RigidMotion{});
  expect(WaveMotion{});
}

}  // namespace supple::description_test
