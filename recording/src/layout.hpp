#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "supple/record_info.hpp"
#include "supple/types.hpp"

// The content of a recording and its location in the file, as docs/recording.md describes. Rows refer to
// objects by their index in the file, in `ObjectId::index`.

namespace supple {

inline constexpr const char* format_name = "supple recording";
inline constexpr const char* format_name_of_rank = "supple recording, objects of a rank";
inline constexpr std::uint32_t format_version = 4;
/// The oldest supported version. Values that it lacks get their defaults.
inline constexpr std::uint32_t oldest_version = 1;

// The names of attributes and columns of this version in another version.
std::string attribute_in_version(const std::string& name, std::uint32_t version);
std::string column_in_version(const std::string& name, std::uint32_t version);

/// A dataset that holds one field of each row.
struct Column {
  std::string name;
  ScalarType type = ScalarType::uint32;
  std::size_t width = 1;
  std::size_t offset = 0;  ///< of the field in a row
  bool is_truth = false;   ///< a truth value; every number but 0 is true
  bool is_object = false;  ///< the field is an `ObjectId`; the file has the index of the object

  std::size_t bytes() const { return size_of(type) * width; }
};

/// A feature has two columns, `feature_a` and `feature_index_a`: the name of the second.
inline std::string name_of_feature_index(std::string name) {
  return name.insert(std::string_view("feature").size(), "_index");
}

/// A group with any number of rows per frame.
struct ListLayout {
  std::string group;
  std::size_t row_bytes = 0;
  std::vector<Column> columns;
};

/// Those of a result, in the order of `list_infos`.
const std::vector<ListLayout>& list_layouts();
/// One column for each statistic; the rows are `StepStats`.
const std::vector<Column>& columns_of_statistics();

inline constexpr const char* statistics_group = "statistics";  // one row per frame

inline std::string object_path(std::size_t place) {
  return "objects/" + std::to_string(place);
}

/// The file of the objects of a rank: `run.rank1.h5` beside `run.h5`.
std::filesystem::path file_of_rank(const std::filesystem::path& recording, std::uint32_t rank);

}  // namespace supple
