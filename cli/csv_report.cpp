#include "csv_report.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "supple/result_descriptions.hpp"
#include "text.hpp"

namespace supple::cli {

namespace {

/// An edge has two ids; a vertex or a face has one.
std::string ids_of(const std::array<std::uint32_t, 2>& element, FeatureKind kind) {
  if (kind == FeatureKind::edge) return fmt::format("{},{}", element[0], element[1]);
  return fmt::format("{},", element[0]);
}

}  // namespace

CsvReport::CsvReport(const std::string& file_name, const SceneOptions& options)
    : file_(file_name), has_kinds_(options.comparison.colliding_vertices) {
  const bool continuous = contains(options.contacts, ContactKinds::continuous);
  const bool proximity = contains(options.contacts, ContactKinds::proximity);
  has_penetration_ = contains(options.contacts, ContactKinds::penetration);
  const char* const heading = has_penetration_ ? "frame,a,b,vertex,triangle,depth\n"
                              : proximity      ? "frame,a,b,kind,a0,a1,b0,b1,distance\n"
                              : continuous     ? "frame,a,b,kind,a0,a1,b0,b1,toi,certainty\n"
                              : has_kinds_     ? "frame,a,b,kind,i,j\n"
                                               : "frame,a,b,i,j\n";
  columns_ = static_cast<std::size_t>(std::ranges::count(std::string_view(heading), ',')) + 1;
  std::fputs(heading, file_.stream());
}

void CsvReport::finish(bool is_truncated) {
  if (is_truncated) std::fputs(("truncated" + std::string(columns_ - 1, ',') + "\n").c_str(), file_.stream());
  file_.close();
}

void CsvReport::add(const Frame& frame) {
  fmt::memory_buffer rows;
  for (const Penetration& p : frame.result.penetrations) {
    fmt::format_to(fmt::appender(rows), "{},{},{},{},{},{}\n", frame.number, p.object_a.index,
                   p.object_b.index, p.vertex, p.triangle, p.depth);
  }
  for (const Contact& c : has_penetration_ ? std::span<const Contact>() : frame.result.contacts) {
    fmt::format_to(fmt::appender(rows), "{},{},{},{}{},{}\n", frame.number, c.object_a.index,
                   c.object_b.index, has_kinds_ ? "contact," : "", c.triangle_a, c.triangle_b);
  }
  for (const ContinuousContact& c : frame.result.continuous_contacts) {
    fmt::format_to(fmt::appender(rows), "{},{},{},{},{},{},{},{}\n", frame.number, c.object_a.index,
                   c.object_b.index, word_of(c.kind), ids_of(c.element_a, feature_kinds(c.kind)[0]),
                   ids_of(c.element_b, feature_kinds(c.kind)[1]), c.toi, word_of(c.certainty));
  }
  for (const ProximityPair& p : frame.result.proximity_pairs) {
    fmt::format_to(fmt::appender(rows), "{},{},{},{},{},{},{}\n", frame.number, p.object_a.index,
                   p.object_b.index, kind_word(p.kind_a, p.kind_b), ids_of(p.element_a, p.kind_a),
                   ids_of(p.element_b, p.kind_b), p.distance);
  }
  if (has_kinds_) add_narrow_phase(frame, rows);
  std::fwrite(rows.data(), 1, rows.size(), file_.stream());
  file_.check();
}

/// Adds the paper's output.
void CsvReport::add_narrow_phase(const Frame& frame, fmt::memory_buffer& rows) {
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
