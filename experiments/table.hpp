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

/// What an experiment measured, one row for each run or round.
struct Table {
  std::string name;                  ///< of the CSV file, without its ending
  std::vector<std::string> columns;  ///< lower_case, with the unit
  std::vector<std::vector<Cell>> rows{};

  /// Throws `Error` unless there is a cell for each column.
  void add(std::vector<Cell> row);
};

/// CSV as in RFC 4180, with line feeds, and quotes around texts with #, which begins a comment. Measured
/// numbers have enough digits to read back the same number; one that is not a number is an empty field.
std::string csv_of(const Table& table);
/// One line of CSV with its line feed.
std::string csv_of(const std::vector<Cell>& row);

/// The fields of CSV text, line by line, with the names of the columns and without comments.
struct CsvText {
  std::vector<std::vector<std::string>> rows{};
  std::size_t length = 0;  ///< of the complete lines; a line without line feed at the end is left out
};
CsvText parse_csv(std::string_view text);

}  // namespace supple::experiments
