#include "layout.hpp"

#include <span>

namespace supple {
namespace {

std::vector<Column> columns_of(const RecordInfo& record) {
  std::vector<Column> columns;
  for (const FieldInfo& field : record.fields) {
    const bool is_truth = field.scalar == ScalarType::boolean;
    const ScalarType stored = is_truth ? ScalarType::uint8 : field.scalar;
    switch (field.kind) {
      case FieldInfo::Kind::numbers:
        columns.push_back({field.name, stored, field.count, field.offset, is_truth, false});
        break;
      case FieldInfo::Kind::object:
        columns.push_back({std::string("object_") + field.role.side, stored, 1,
                           field.offset + offsetof(ObjectId, index), false, true});
        break;
      case FieldInfo::Kind::feature:
        columns.push_back({field.name, stored, 1, field.offset + offsetof(Feature, kind), false, false});
        columns.push_back({name_of_feature_index(field.name), stored, 1,
                           field.offset + offsetof(Feature, index), false, false});
    }
  }
  return columns;
}

}  // namespace

const std::vector<ListLayout>& list_layouts() {
  static const std::vector<ListLayout> layouts = [] {
    std::vector<ListLayout> all;
    for (const ListInfo& list : list_infos())
      all.push_back({list.name, list.record.bytes, columns_of(list.record)});
    return all;
  }();
  return layouts;
}

const std::vector<Column>& columns_of_statistics() {
  static const std::vector<Column> columns = columns_of(record_info<StepStats>());
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
