#include "table.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "supple/error.hpp"

namespace supple::experiments {
namespace {

std::string csv_field(const Cell& cell) {
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return fmt::format("{}", *count);
  if (const auto* number = std::get_if<double>(&cell))
    return std::isnan(*number) ? "" : fmt::format("{}", *number);
  const auto* text = std::get_if<std::string>(&cell);
  if (text == nullptr) return "";
  if (text->find_first_of(",\"\n\r#") == std::string::npos) return *text;
  std::string quoted = "\"";
  for (const char c : *text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size())
    throw Error(fmt::format("table {}: a row of {} cells for {} columns", name, row.size(), columns.size()));
  rows.push_back(std::move(row));
}

std::string csv_of(const Table& table) {
  std::string result;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (c > 0) result += ',';
    result += table.columns[c];
  }
  result += '\n';
  for (const auto& row : table.rows) result += csv_of(row);
  return result;
}

std::string csv_of(const std::vector<Cell>& row) {
  std::string result;
  for (std::size_t c = 0; c < row.size(); ++c) {
    if (c > 0) result += ',';
    result += csv_field(row[c]);
  }
  return result + '\n';
}

CsvText parse_csv(std::string_view text) {
  CsvText result;
  std::vector<std::string> row(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '#' && !is_quoted && row.size() == 1 && row.back().empty()) {
      const std::size_t end = text.find('\n', i);
      if (end == std::string_view::npos) break;
      result.length = end + 1;
      i = end;
    } else if (c == '"') {
      // A quote that follows the end of a quoted part stands for a quote.
      if (!is_quoted && i > 0 && text[i - 1] == '"') row.back() += c;
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      row.emplace_back();
    } else if (c == '\n' && !is_quoted) {
      result.rows.push_back(std::move(row));
      row.assign(1, {});
      result.length = i + 1;
    } else {
      row.back() += c;
    }
  }
  return result;
}

}  // namespace supple::experiments
