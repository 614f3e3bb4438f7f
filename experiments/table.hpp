#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace supple::experiments {

/// The value of a cell: nothing, a word, a count or a measured number.
using Cell = std::variant<std::monostate, std::string, std::uint64_t, double>;

/// A measured number; nothing for NaN.
Cell cell_of(double number);

struct Column {
  std::string name;     ///< in the CSV file: lower_case, with the unit
  std::string heading;  ///< on the terminal and in the report
  int digits = 3;       ///< significant digits of measured numbers, except in the CSV file
};

/// One table for the terminal, the CSV file and the report.
struct Table {
  std::string name;  ///< of the CSV file, without its ending
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows{};
  /// Comments of a file that an earlier program began, with its commit; empty: those of this program.
  std::string head{};

  /// Throws `Error` unless there is a cell for each column.
  void add(std::vector<Cell> row);
};

/// The text for the terminal and the report: grouped thousands, and measured numbers with the digits of the
/// column.
std::string text_of(const Cell& cell, const Column& column);
/// Aligned columns under the caption.
std::string text_of(const Table& table);
/// CSV as in RFC 4180, with line feeds, and quotes around texts with #, which begins a comment. Measured
/// numbers have enough digits to read back the same number.
std::string csv_of(const Table& table);
/// One line of CSV with its line feed.
std::string csv_of(const std::vector<Cell>& row);

/// The fields of CSV text, line by line, with the names of the columns and without comments.
struct CsvText {
  std::vector<std::vector<std::string>> rows{};
  std::size_t length = 0;  ///< of the complete lines; a line without line feed at the end is left out
};
CsvText parse_csv(std::string_view text);

/// The comments at the head of CSV text.
std::string head_of(std::string_view text);

/// The value with `digits` significant digits. Only numbers far from 1 are in scientific notation.
std::string rounded(double value, int digits = 3);

}  // namespace supple::experiments
