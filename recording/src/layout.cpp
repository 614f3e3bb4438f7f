#include "layout.hpp"

#include <span>
#include <utility>

namespace supple {
namespace {

template <class Struct, class Value>
std::size_t offset_of(Value Struct::*member) {
  const Struct row{};
  return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&(row.*member)) -
                                  reinterpret_cast<const std::byte*>(&row));
}

template <class Value>
Column column(std::string name, std::size_t offset) {
  using Stored = Storage<Value>;
  static_assert(sizeof(Value) == size_of(Stored::type) * Stored::width);
  return {std::move(name), Stored::type, Stored::width, offset, std::is_same_v<Value, bool>, false};
}

template <Described Row>
std::vector<Column> columns_of_record() {
  static_assert(std::is_trivially_copyable_v<Row>);
  std::vector<Column> columns;
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
    const std::size_t offset = offset_of(field.member);
    if constexpr (std::is_same_v<Value, ObjectId>) {
      columns.push_back(column<std::uint32_t>(std::string("object_") + field.role.side,
                                              offset + offset_of(&ObjectId::index)));
      columns.back().is_object = true;
    } else if constexpr (std::is_same_v<Value, Feature>) {
      columns.push_back(column<FeatureKind>(field.key, offset + offset_of(&Feature::kind)));
      columns.push_back(
          column<std::uint8_t>(name_of_feature_index(field.key), offset + offset_of(&Feature::index)));
    } else {
      columns.push_back(column<Value>(field.key, offset));
    }
  });
  return columns;
}

}  // namespace

const std::vector<ListLayout>& list_layouts() {
  static const std::vector<ListLayout> layouts = [] {
    std::vector<ListLayout> all;
    for_each_list([&]<class Row>(const ResultList<Row>& list, auto) {
      if constexpr (Described<Row>)
        all.push_back({list.name, sizeof(Row), columns_of_record<Row>()});
      else
        all.push_back({list.name, sizeof(Row), {column<Row>(list.value, 0)}});
    });
    return all;
  }();
  return layouts;
}

const std::vector<Column>& columns_of_statistics() {
  static const std::vector<Column> columns = columns_of_record<StepStats>();
  return columns;
}

namespace {

struct Renamed {
  const char* now;
  const char* in_version_1;
};

std::string old_name(const std::string& name, std::uint32_t version, std::span<const Renamed> renamed) {
  if (version >= 2) return name;
  for (const Renamed& one : renamed) {
    if (name == one.now) return one.in_version_1;
  }
  return name;
}

}  // namespace

std::string attribute_in_version(const std::string& name, std::uint32_t version) {
  static constexpr Renamed renamed[] = {
      {"contacts", "contact_mode"},
      {"undecided", "exact_impacts"},
      {"region_test", "region_sphere_test"},
      {"self", "self_collision"},
      {"static", "is_static"},
      {"max_level", "octree_max_level"},
      {"leaf_size", "octree_leaf_size"},
  };
  return old_name(name, version, renamed);
}

std::filesystem::path file_of_rank(const std::filesystem::path& recording, std::uint32_t rank) {
  if (rank == 0) return recording;
  return recording.parent_path() /
         (recording.stem().string() + ".rank" + std::to_string(rank) + recording.extension().string());
}

std::string column_in_version(const std::string& name, std::uint32_t version) {
  static constexpr Renamed renamed[] = {
      {"sort_and_events_seconds", "finish_seconds"},
      {"toi", "time"},
      {"barycentric_a", "weights_a"},
      {"barycentric_b", "weights_b"},
  };
  return old_name(name, version, renamed);
}

}  // namespace supple
