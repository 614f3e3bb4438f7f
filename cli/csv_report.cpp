#include "csv_report.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

namespace supple::cli {

CsvReport::CsvReport(const std::string& file_name) : file_(file_name) {
  std::fputs("frame,a,b,i,j\n", file_.stream());
}

void CsvReport::add(const Frame& frame) {
  fmt::memory_buffer rows;
  for (const Contact& c : frame.result.contacts) {
    fmt::format_to(fmt::appender(rows), "{},{},{},{},{}\n", frame.number, c.object_a.index, c.object_b.index,
                   c.triangle_a, c.triangle_b);
  }
  std::fwrite(rows.data(), 1, rows.size(), file_.stream());
  file_.check();
}

}  // namespace supple::cli
