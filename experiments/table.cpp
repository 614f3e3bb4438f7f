#include "table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/text.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace {

/// Counts characters, not bytes: all bytes of UTF-8 except continuation bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
  const std::string blanks(width - std::min(width, width_of(text)), ' ');
  return to_the_right ? blanks + text : text + blanks;
}

std::string csv_field(const Cell& cell) {
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return fmt::format("{}", *count);
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number);
  const auto* text = std::get_if<std::string>(&cell);
  if (text == nullptr) return "";
  if (text->find_first_of(",\"\n\r#") == std::string::npos) return *text;
  std::string quoted = "\"";
  for (const char c : *text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace

Cell cell_of(double number) {
  if (std::isnan(number)) return {};
  return number;
}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size())
    throw Error(fmt::format("table {}: a row of {} cells for {} columns", name, row.size(), columns.size()));
  rows.push_back(std::move(row));
}

std::string rounded(double value, int digits) {
  if (!std::isfinite(value)) return std::isnan(value) ? "–" : value > 0 ? "∞" : "-∞";
  if (value == 0) return "0";
  const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
  const int magnitude = std::stoi(scientific.substr(scientific.find('e') + 1));
  if (magnitude < -5 || magnitude > 8) return scientific;
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - magnitude));
}

std::string text_of(const Cell& cell, const Column& column) {
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return cli::grouped(*count);
  if (const auto* number = std::get_if<double>(&cell)) return rounded(*number, column.digits);
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return "–";
}

std::string text_of(const Table& table) {
  const std::size_t count = table.columns.size();
  std::vector<std::size_t> widths(count);
  std::vector<bool> right(count, true);
  for (std::size_t c = 0; c < count; ++c) {
    widths[c] = width_of(table.columns[c].heading);
    for (const auto& row : table.rows) {
      widths[c] = std::max(widths[c], width_of(text_of(row[c], table.columns[c])));
      if (std::holds_alternative<std::string>(row[c])) right[c] = false;
    }
  }
  const auto line = [&](const auto& text) {
    std::string result;
    for (std::size_t c = 0; c < count; ++c)
      result.append(2, ' ').append(padded(text(c), widths[c], right[c]));
    result.erase(result.find_last_not_of(' ') + 1);
    return result + '\n';
  };
  std::string result = table.caption + '\n';
  result += line([&](std::size_t c) { return table.columns[c].heading; });
  for (const auto& row : table.rows)
    result += line([&](std::size_t c) { return text_of(row[c], table.columns[c]); });
  return result;
}

std::string csv_of(const Table& table) {
  std::string result;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (c > 0) result += ',';
    result += table.columns[c].name;
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

std::string head_of(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] == '#') end = std::min(text.find('\n', end), text.size() - 1) + 1;
  return std::string(text.substr(0, end));
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
