#include "csv_report.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <array>

#include "supple/result_descriptions.hpp"

namespace supple::cli {

namespace {

/// An edge has two ids; a vertex or a face has one.
std::string ids_of(const std::array<std::uint32_t, 2>& element, ElementPairKind kind) {
  if (kind == ElementPairKind::edge_edge) return fmt::format("{},{}", element[0], element[1]);
  return fmt::format("{},", element[0]);
}

}  // namespace

CsvReport::CsvReport(const std::string& file_name, ContactKinds contacts) : file_(file_name) {
  const bool continuous = contains(contacts, ContactKinds::continuous);
  std::fputs(continuous ? "frame,a,b,kind,a0,a1,b0,b1,toi,certainty\n" : "frame,a,b,i,j\n", file_.stream());
}

void CsvReport::add(const Frame& frame) {
  fmt::memory_buffer rows;
  for (const Contact& c : frame.result.contacts) {
    fmt::format_to(fmt::appender(rows), "{},{},{},{},{}\n", frame.number, c.object_a.index, c.object_b.index,
                   c.triangle_a, c.triangle_b);
  }
  for (const ContinuousContact& c : frame.result.continuous_contacts) {
    fmt::format_to(fmt::appender(rows), "{},{},{},{},{},{},{},{}\n", frame.number, c.object_a.index,
                   c.object_b.index, word_of(c.kind), ids_of(c.element_a, c.kind),
                   ids_of(c.element_b, c.kind), c.toi, word_of(c.certainty));
  }
  std::fwrite(rows.data(), 1, rows.size(), file_.stream());
  file_.check();
}

}  // namespace supple::cli
