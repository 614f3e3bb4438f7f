#include "reports/reports.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <bit>
#include <string_view>
#include <utility>

#include "base/files.hpp"
#include "base/text.hpp"
#include "reports/result_json.hpp"

namespace supple::cli {

namespace {

/// Calls `visit(field)` for each member that has columns.
template <class Visit>
void for_each_cell(const RecordInfo& record, bool details, Visit visit) {
  for (const FieldInfo& field : record.fields) {
    const bool is_detail = field.scalar == ScalarType::float64 && field.count > 1;
    if (!is_of_range(field.role) && (details || !is_detail)) visit(field);
  }
}

/// The place of the list of the last of these kinds, if any: with penetration, the intersections are not the
/// answer.
std::optional<std::size_t> place_of_last(ContactKinds kinds) {
  const auto last = static_cast<ContactKinds>(std::bit_floor(static_cast<unsigned>(kinds)));
  return last == ContactKinds::none ? std::nullopt : std::optional(place_of_answer(last));
}

void add_row(fmt::memory_buffer& rows, std::uint64_t frame, const RecordInfo& record, const std::byte* row,
             bool details) {
  const fmt::appender out(rows);
  fmt::format_to(out, "{}", frame);
  for_each_cell(record, details, [&](const FieldInfo& field) {
    for_each_value(record, field, row, [&]<class Value>(const Value& value) {
      if constexpr (std::is_same_v<Value, std::nullptr_t>)
        rows.push_back(',');
      else
        fmt::format_to(out, ",{}", value);
    });
  });
  rows.push_back('\n');
}

}  // namespace

std::vector<std::string> csv_columns(ContactKinds kinds, bool details) {
  std::vector<std::string> columns{"frame"};
  const std::optional<std::size_t> place = place_of_last(kinds);
  if (!place) return columns;
  for_each_cell(list_infos()[*place].record, details, [&](const FieldInfo& field) {
    const std::string key = short_key(field.name);
    std::string_view parts;
    if (field.role.names == Names::element) parts = "01";
    if (field.scalar == ScalarType::float64 && field.count > 1)
      parts = field.role.names == Names::weights ? "012" : "xyz";
    if (parts.empty()) columns.push_back(key);
    for (const char part : parts) columns.push_back(key + (part < 'a' ? "" : "_") + part);
  });
  return columns;
}

namespace {

/// Writes one row per contact, as docs/json.md describes: the frame, and the members of the record; vectors
/// and weights only with `details`. With colliding vertices, one row per contact of triangles, per vertex and
/// per event of the narrow phase.
class CsvReport : public Report {
 public:
  CsvReport(const std::string& file_name, const SceneOptions& options, bool details)
      : file_(file_name),
        kinds_(options.contacts),
        has_kinds_(options.comparison.colliding_vertices),
        has_details_(details) {
    const std::vector<std::string> columns =
        has_kinds_ ? std::vector<std::string>{"frame", "a", "b", "kind", "i", "j"}
                   : csv_columns(kinds_, has_details_);
    columns_ = columns.size();
    fmt::print(file_.stream(), "{}\n", fmt::join(columns, ","));
  }

  void add(const Frame& frame) override {
    is_truncated_ = is_truncated_ || frame.result.truncated;
    fmt::memory_buffer rows;
    if (has_kinds_) {
      add_narrow_phase(frame, rows);
    } else {
      const std::optional<std::size_t> place = place_of_last(kinds_);
      const ListRows list = place ? supple::rows_of(frame.result)[*place] : ListRows{};
      for (std::size_t i = 0; i < list.count; ++i) {
        const RecordInfo& record = list_infos()[*place].record;
        add_row(rows, frame.number, record, list.data + i * record.bytes, has_details_);
      }
    }
    std::fwrite(rows.data(), 1, rows.size(), file_.stream());
    file_.check();
  }

  /// Adds a row `truncated` with empty cells when the results are not complete.
  void finish(bool was_ended) override {
    if (was_ended || is_truncated_)
      std::fputs(("truncated" + std::string(columns_ - 1, ',') + "\n").c_str(), file_.stream());
    file_.close();
  }

 private:
  /// Adds the contacts of triangles and the paper's output.
  void add_narrow_phase(const Frame& frame, fmt::memory_buffer& rows) {
    for (const Contact& c : frame.result.contacts) {
      fmt::format_to(fmt::appender(rows), "{},{},{},contact,{},{}\n", frame.number, c.object_a.index,
                     c.object_b.index, c.triangle_a, c.triangle_b);
    }
    for (const CollidingVertices& group : frame.result.colliding_vertex_groups) {
      for (std::uint32_t i = 0; i < group.count_a + group.count_b; ++i) {
        const std::uint32_t vertex = frame.result.colliding_vertices[group.first_vertex + i];
        const auto [kind, cells] = i < group.count_a ? std::pair("vertex_a", fmt::format("{},", vertex))
                                                     : std::pair("vertex_b", fmt::format(",{}", vertex));
        fmt::format_to(fmt::appender(rows), "{},{},{},{},{}\n", frame.number, group.a.index, group.b.index,
                       kind, cells);
      }
    }
    const PairEvents& events = frame.result.narrow_phase_events;
    for (const auto& [kind, pairs] :
         {std::pair("narrow_phase_begin", events.begin), std::pair("narrow_phase_end", events.end)}) {
      for (const ObjectPair& pair : pairs)
        fmt::format_to(fmt::appender(rows), "{},{},{},{},,\n", frame.number, pair.a.index, pair.b.index,
                       kind);
    }
  }

  OutputFile file_;
  std::size_t columns_ = 0;
  ContactKinds kinds_;
  bool has_kinds_;  ///< a column says what each row is
  bool has_details_;
  bool is_truncated_ = false;
};

}  // namespace

std::unique_ptr<Report> make_csv_report(const std::string& file_name, const SceneOptions& options,
                                        bool details) {
  return std::make_unique<CsvReport>(file_name, options, details);
}

}  // namespace supple::cli
