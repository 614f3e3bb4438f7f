#include "reports/csv_report.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <array>
#include <bit>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/text.hpp"
#include "reports/record_json.hpp"
#include "supple/result_lists.hpp"

namespace supple::cli {

namespace {

using Weights = std::array<double, 3>;
using Element = std::array<std::uint32_t, 2>;

/// Calls `visitor(field)` for each member that has columns.
template <Described Row, class Visitor>
void for_each_cell(bool details, Visitor visitor) {
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
    constexpr bool is_detail = std::is_same_v<Value, Vec3d> || std::is_same_v<Value, Weights>;
    if (!is_of_range(field.role) && (details || !is_detail)) visitor(field);
  });
}

/// Calls `visitor(list, member)` for the list of the last of these kinds: with penetration, the intersections
/// are not the answer.
template <class Visitor>
void with_answer(ContactKinds kinds, Visitor visitor) {
  const auto last = static_cast<ContactKinds>(std::bit_floor(static_cast<unsigned>(kinds)));
  if (last == ContactKinds::none) return;
  for_each_list([&]<class Row>(const ResultList<Row>& list, auto member) {
    if constexpr (Described<Row>) {
      if (list.answers == last) visitor(list, member);
    }
  });
}

template <Described Row>
void add_row(fmt::memory_buffer& rows, std::uint64_t frame, const Row& row, bool details) {
  const fmt::appender out(rows);
  fmt::format_to(out, "{}", frame);
  for_each_cell<Row>(details, [&]<class Value>(const Field<Row, Value>& field) {
    const Value& value = row.*field.member;
    if constexpr (std::is_same_v<Value, ObjectId>) {
      fmt::format_to(out, ",{}", value.index);
    } else if constexpr (std::is_same_v<Value, Vec3d>) {
      fmt::format_to(out, ",{},{},{}", value.x, value.y, value.z);
    } else if constexpr (std::is_same_v<Value, Weights>) {
      const auto last = static_cast<std::size_t>(kind_of_element(row, field.role.side));
      for (std::size_t i = 0; i < value.size(); ++i)
        i <= last ? fmt::format_to(out, ",{}", value[i]) : fmt::format_to(out, ",");
    } else if constexpr (std::is_same_v<Value, Element>) {
      const bool is_edge = kind_of_element(row, field.role.side) == FeatureKind::edge;
      is_edge ? fmt::format_to(out, ",{},{}", value[0], value[1]) : fmt::format_to(out, ",{},", value[0]);
    } else if constexpr (std::is_same_v<Value, Feature>) {
      fmt::format_to(out, ",{}", name_of(value));
    } else if constexpr (Worded<Value>) {
      fmt::format_to(out, ",{}", word_of(value));
    } else {
      fmt::format_to(out, ",{}", value);
    }
  });
  rows.push_back('\n');
}

}  // namespace

std::vector<std::string> csv_columns(ContactKinds kinds, bool details) {
  std::vector<std::string> columns{"frame"};
  with_answer(kinds, [&]<class Row>(const ResultList<Row>&, auto) {
    for_each_cell<Row>(details, [&]<class Value>(const Field<Row, Value>& field) {
      std::string_view parts;
      if constexpr (std::is_same_v<Value, Vec3d>) parts = "xyz";
      if constexpr (std::is_same_v<Value, Weights>) parts = "012";
      if constexpr (std::is_same_v<Value, Element>) parts = "01";
      const std::string key = short_key(field.key);
      if (parts.empty()) columns.push_back(key);
      for (const char part : parts) columns.push_back(key + (part < 'a' ? "" : "_") + part);
    });
  });
  return columns;
}

CsvReport::CsvReport(const std::string& file_name, const SceneOptions& options, bool details)
    : file_(file_name),
      kinds_(options.contacts),
      has_kinds_(options.comparison.colliding_vertices),
      has_details_(details) {
  const std::vector<std::string> columns = has_kinds_
                                               ? std::vector<std::string>{"frame", "a", "b", "kind", "i", "j"}
                                               : csv_columns(kinds_, has_details_);
  columns_ = columns.size();
  fmt::print(file_.stream(), "{}\n", fmt::join(columns, ","));
}

void CsvReport::finish(bool is_truncated) {
  if (is_truncated) std::fputs(("truncated" + std::string(columns_ - 1, ',') + "\n").c_str(), file_.stream());
  file_.close();
}

void CsvReport::add(const Frame& frame) {
  fmt::memory_buffer rows;
  if (has_kinds_) {
    add_narrow_phase(frame, rows);
  } else {
    with_answer(kinds_, [&](const auto&, auto member) {
      for (const auto& row : member(frame.result)) add_row(rows, frame.number, row, has_details_);
    });
  }
  std::fwrite(rows.data(), 1, rows.size(), file_.stream());
  file_.check();
}

/// Adds the contacts of triangles and the paper's output.
void CsvReport::add_narrow_phase(const Frame& frame, fmt::memory_buffer& rows) {
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
      fmt::format_to(fmt::appender(rows), "{},{},{},{},,\n", frame.number, pair.a.index, pair.b.index, kind);
  }
}

}  // namespace supple::cli
