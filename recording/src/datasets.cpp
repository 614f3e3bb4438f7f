#include "datasets.hpp"

#include <array>
#include <cstring>
#include <tuple>
#include <type_traits>

#include "supple/option_descriptions.hpp"
#include "supple/version.hpp"

namespace supple {
namespace {

constexpr std::size_t frames_in_chunk = 1024;
constexpr std::size_t rows_in_chunk = 4096;

std::vector<ColumnWriter> create_columns(hid_t file, const std::string& group,
                                         const std::vector<Column>& columns, std::size_t chunk_rows) {
  create_group(file, group);
  std::vector<ColumnWriter> writers;
  for (const Column& column : columns)
    writers.emplace_back(file, group + "/" + column.name, column.type, column.width, chunk_rows);
  return writers;
}

/// One attribute per option, except the options of the machine.
template <class Options>
void write_options(hid_t file, const std::string& group, const Options& options) {
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if (field.is_of_machine) return;
        if constexpr (Worded<Value>) {
          write_attribute(file, group, field.key, std::string(word_of(value)));
        } else if constexpr (std::is_same_v<Value, std::optional<RootCube>>) {
          if (!value) return;
          const auto& [corner, edge] = *value;
          write_attribute(file, group, field.key, std::array{corner.x, corner.y, corner.z, edge});
        } else {
          if constexpr (std::is_same_v<Value, bool>) {
            if (field.has_truth_words())
              return write_attribute(file, group, field.key, std::string(field.truth_words[value ? 1 : 0]));
          }
          write_attribute(file, group, field.key, value);
        }
      },
      options);
}

void write_header(hid_t file, const RecordingHeader& header) {
  const auto attribute = [file](const char* name, auto value) { write_attribute(file, "/", name, value); };
  attribute("format", std::string(format_name));
  attribute("version", format_version);
  attribute("program_version", std::string(SUPPLE_VERSION));
  attribute("time_step", header.time_step);
  if (header.ranks != 1) attribute("ranks", header.ranks);
  write_options(file, "/", header.scene);
  write_text(file, "scene_file", header.scene_file);
}

PositionsWriter write_object(hid_t file, std::size_t place, const RecordedObject& object) {
  const std::string path = object_path(place);
  create_group(file, path);
  const auto attribute = [&](const char* name, auto value) { write_attribute(file, path, name, value); };
  attribute("id_index", object.id.index);
  attribute("id_generation", object.id.generation);
  write_options(file, path, object.options);
  write_rows(file, path + "/rest_positions", ScalarType::float64, object.rest_positions.size(), 3,
             object.rest_positions.data());
  write_rows(file, path + "/triangles", ScalarType::uint32, object.triangles.size(), 3,
             object.triangles.data());
  const auto& [edges, points] = std::tie(object.options.edges, object.options.points);
  if (!edges.empty()) write_rows(file, path + "/edges", ScalarType::uint32, edges.size(), 2, edges.data());
  if (!points.empty())
    write_rows(file, path + "/points", ScalarType::uint32, points.size(), 0, points.data());
  return {file, path + "/positions", object.rest_positions.size()};
}

}  // namespace

std::vector<ListRows> checked_rows(const DetectResult& result, const Places& place_of) {
  std::vector<ListRows> all = rows_of(result);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const RecordInfo& record = list_infos()[i].record;
    for (const FieldInfo& field : record.fields) {
      for (std::size_t row = 0; field.kind == FieldInfo::Kind::object && row < all[i].count; ++row) {
        ObjectId id;
        std::memcpy(&id, all[i].data + row * record.bytes + field.offset, sizeof id);
        place_of(id);
      }
    }
  }
  return all;
}

RaggedWriter::RaggedWriter(hid_t file, const ListLayout& layout)
    : layout_(&layout),
      columns_(create_columns(file, layout.group, layout.columns, rows_in_chunk)),
      end_(file, layout.group + "/end", ScalarType::uint64, 1, frames_in_chunk) {}

void RaggedWriter::append(const ListRows& rows, const Places& place_of) {
  for (std::size_t c = 0; rows.count > 0 && c < columns_.size(); ++c) {
    const Column& column = layout_->columns[c];
    std::byte* to = columns_[c].append(rows.count);
    const std::byte* from = rows.data + column.offset;
    for (std::size_t row = 0; row < rows.count; ++row, to += column.bytes(), from += layout_->row_bytes) {
      if (column.is_object) {
        ObjectId id;
        std::memcpy(&id, from, sizeof id);
        const std::uint32_t place = place_of(id);
        std::memcpy(to, &place, sizeof place);
      } else {
        std::memcpy(to, from, column.bytes());
      }
    }
  }
  rows_ += rows.count;
  end_.append_value(&rows_);
}

bool is_of_several_ranks(const RecordingHeader& header) {
  return std::any_of(header.objects.begin(), header.objects.end(),
                     [](const RecordedObject& object) { return object.elsewhere.has_value(); });
}

void check_header(const RecordingHeader& header) {
  for (std::size_t place = 0; place < header.objects.size(); ++place) {
    const RecordedObject& object = header.objects[place];
    if (object.elsewhere) continue;
    const auto check = [&](const char* what, std::size_t i, std::span<const std::uint32_t> vertices) {
      for (const std::uint32_t vertex : vertices) {
        if (vertex >= object.rest_positions.size())
          throw Error(std::string(what) + " " + std::to_string(i) + " of object " + std::to_string(place) +
                      " of a recording uses vertex " + std::to_string(vertex) + " of " +
                      std::to_string(object.rest_positions.size()) + "; give the mesh that the scene has");
      }
    };
    const auto& [edges, points] = std::tie(object.options.edges, object.options.points);
    for (std::size_t t = 0; t < object.triangles.size(); ++t) check("triangle", t, object.triangles[t]);
    for (std::size_t i = 0; i < edges.size(); ++i) check("edge", i, edges[i]);
    for (std::size_t i = 0; i < points.size(); ++i) check("point", i, {&points[i], 1});
  }
}

Datasets::Datasets(hid_t file, const std::filesystem::path& recording, const RecordingHeader& header,
                   const RecordingRank& rank) {
  if (rank.rank == 0)
    write_header(file, header);
  else
    write_attribute(file, "/", "format", std::string(format_name_of_rank));
  if (rank.rank != 0 || is_of_several_ranks(header)) write_attribute(file, "/", "run", rank.run);
  create_group(file, "objects");
  for (std::size_t place = 0; place < header.objects.size(); ++place) {
    const RecordedObject& object = header.objects[place];
    positions.emplace_back();
    if (!object.elsewhere)
      positions.back() = write_object(file, place, object);
    else if (rank.rank == 0)
      create_external_link(file, object_path(place),
                           file_of_rank(recording, object.elsewhere->rank).filename().string());
  }
  if (rank.rank != 0) return;
  create_group(file, "events");
  for (const ListLayout& layout : list_layouts()) lists.emplace_back(file, layout);
  statistics = create_columns(file, statistics_group, columns_of_statistics(), frames_in_chunk);
  // `time` is created last, so it grows last: a frame exists when its time exists.
  time.emplace(file, "time", ScalarType::float64, 1, frames_in_chunk);
}

}  // namespace supple
