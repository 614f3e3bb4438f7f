#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hdf5/write.hpp"
#include "layout.hpp"
#include "supple/error.hpp"
#include "supple/recording.hpp"

namespace supple {

/// Maps object ids of results to indices in the file.
class Places {
 public:
  explicit Places(const std::vector<RecordedObject>& objects) {
    for (std::size_t place = 0; place < objects.size(); ++place) {
      const ObjectId id = objects[place].id;
      if (id.index >= by_index_.size()) by_index_.resize(id.index + std::size_t{1});
      if (by_index_[id.index])
        throw Error("objects " + std::to_string(by_index_[id.index]->place) + " and " +
                    std::to_string(place) + " of a recording have the same id; give each its own");
      by_index_[id.index] = Entry{id.generation, static_cast<std::uint32_t>(place)};
    }
  }

  std::uint32_t operator()(ObjectId id) const {
    if (id.index >= by_index_.size() || !by_index_[id.index] ||
        by_index_[id.index]->generation != id.generation)
      throw Error("a result names object " + std::to_string(id.index) + " of generation " +
                  std::to_string(id.generation) +
                  ", which the recording's header does not have; list every object");
    return by_index_[id.index]->place;
  }

 private:
  struct Entry {
    std::uint32_t generation = 0, place = 0;
  };
  std::vector<std::optional<Entry>> by_index_;
};

/// The rows of all lists. Throws `Error` when a row names an object that the recording does not have.
std::vector<ListRows> checked_rows(const DetectResult& result, const Places& place_of);

/// A group with any number of rows per frame, and the end of each frame.
class RaggedWriter {
 public:
  RaggedWriter(hid_t file, const ListLayout& layout);

  void append(const ListRows& rows, const Places& place_of);
  template <class Function>
  void for_each_column(Function function) {
    for (ColumnWriter& column : columns_) function(column);
    function(end_);
  }

 private:
  const ListLayout* layout_;
  std::vector<ColumnWriter> columns_;
  ColumnWriter end_;
  std::uint64_t rows_ = 0;
};

/// Whether other ranks have some of the objects.
bool is_of_several_ranks(const RecordingHeader& header);

/// Throws `Error` when a triangle, an edge or a point uses a vertex that does not exist.
void check_header(const RecordingHeader& header);

/// The growing datasets of a file, and their unwritten rows.
struct Datasets {
  /// A rank other than 0 writes only its objects.
  Datasets(hid_t file, const std::filesystem::path& recording, const RecordingHeader& header,
           const RecordingRank& rank);

  template <class Function>
  void for_each_column(Function function) {
    for (RaggedWriter& list : lists) list.for_each_column(function);
    for (ColumnWriter& column : statistics) function(column);
    if (time) function(*time);
  }

  std::vector<std::optional<PositionsWriter>> positions;  ///< empty for objects that are elsewhere
  std::vector<RaggedWriter> lists;                        ///< in the order of `list_infos`
  std::vector<ColumnWriter> statistics;
  std::optional<ColumnWriter> time;
};

}  // namespace supple
