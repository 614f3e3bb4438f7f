#include "query/query_file.hpp"

#include <fmt/core.h>
#include <rapidjson/error/en.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/files.hpp"
#include "base/text.hpp"
#include "query/rational.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t rows_of_query = 8;
constexpr std::size_t columns_of_point = 6;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> columns_of(std::string_view line) {
  std::vector<std::string_view> columns;
  for (;;) {
    const std::size_t comma = line.find(',');
    columns.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return columns;
    line.remove_prefix(comma + 1);
  }
}

/// Largest number of characters of a number in a message.
constexpr std::size_t longest_shown = 60;

/// Shortens numbers with hundreds of digits for messages.
std::string shortened(std::string_view text) {
  return text.size() <= longest_shown ? std::string(text)
                                      : fmt::format("{}...", text.substr(0, longest_shown));
}

/// Advice for a coordinate that is not a double.
std::string advice_for(const Rational& value) {
  const double nearest = value.convert_to<double>();
  if (!std::isfinite(nearest)) return "it is beyond the range of doubles, so scale the query down";
  const Rational exact(nearest);
  const std::string fraction = fmt::format("{}/{}", boost::multiprecision::numerator(exact).str(),
                                           boost::multiprecision::denominator(exact).str());
  if (fraction.size() > longest_shown) return fmt::format("round it to the nearest double, {}", nearest);
  return fmt::format("round it to the nearest double, {}", fraction);
}

struct Row {
  Vec3d point;
  std::optional<bool> answer;
};

/// Reads row by row and skips empty lines.
class RowReader {
 public:
  explicit RowReader(const fs::path& path) : path_(path), stream_(open_input(path)) {}

  std::optional<Row> next() {
    std::string line;
    do {
      if (!std::getline(stream_, line)) {
        if (stream_.bad()) fail("reading failed; is the disk all right?");
        return std::nullopt;
      }
      ++line_number_;
    } while (trimmed(line).empty());
    const std::vector<std::string_view> columns = columns_of(line);
    check_column_count(columns.size());
    Row row;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t column = 2 * static_cast<std::size_t>(axis);
      row.point[axis] = coordinate("xyz"[axis], columns[column], columns[column + 1]);
    }
    if (columns.size() > columns_of_point) row.answer = answer(columns.back());
    return row;
  }

  std::uint64_t line_number() const { return line_number_; }
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> what, Args&&... args) const {
    cli::fail("{}:{}: {}", path_.string(), line_number_, fmt::format(what, std::forward<Args>(args)...));
  }

 private:
  Integer integer(std::string_view text) const {
    std::optional<Integer> value = parse_integer(text);
    if (!value) fail("'{}' is not a whole number; a coordinate is numerator,denominator", shortened(text));
    return *std::move(value);
  }

  double coordinate(char axis, std::string_view numerator, std::string_view denominator) const {
    const auto fail_with = [&](const std::string& what) {
      fail("{} = {}/{} {}", axis, shortened(numerator), shortened(denominator), what);
    };
    if (const std::optional<double> usual = exact_small_quotient(numerator, denominator)) return *usual;
    const Integer top = integer(numerator), bottom = integer(denominator);
    if (bottom == 0) fail_with("has the denominator 0; any other whole number is allowed");
    // Boost's fractions have positive denominators.
    const Rational value(bottom < 0 ? -top : top, abs(bottom));
    const std::optional<double> exact = exact_double(value);
    if (!exact) fail_with("is not the exact value of a double; " + advice_for(value));
    return *exact;
  }

  bool answer(std::string_view text) const {
    if (text != "0" && text != "1") fail("the answer '{}' must be 0 or 1", shortened(text));
    return text == "1";
  }

  void check_column_count(std::size_t count) {
    if (count != columns_of_point && count != columns_of_point + 1)
      fail(
          "has {} instead of 6 or 7: a row is numerator,denominator of x, y and z, and optionally "
          "the answer, 0 or 1",
          counted(count, "column"));
    if (column_count_ == 0) column_count_ = count;
    if (count != column_count_)
      fail("has {} columns, but the first row has {}; all rows or no row must have the answer as column 7",
           count, column_count_);
  }

  const fs::path& path_;
  std::ifstream stream_;
  std::uint64_t line_number_ = 0;
  std::size_t column_count_ = 0;  ///< of the first row
};

/// The rows of one query: v, f0, f1, f2 or a0, a1, b0, b1 at the start and then at the end.
template <class Motion>
class QueryReader {
 public:
  explicit QueryReader(const fs::path& path) : rows_(path) {}

  /// False at the end of the file.
  bool read(std::vector<Motion>& motions, std::vector<bool>& answers) {
    Motion motion;
    std::optional<Row> first;
    for (std::size_t i = 0; i < rows_of_query; ++i) {
      const std::optional<Row> row = rows_.next();
      if (!row && i == 0) return false;
      if (!row) fail_incomplete(i);
      if (i == 0) first = row;
      if (row->answer != first->answer)
        rows_.fail(
            "the answer is {:d}, but {:d} in the rows of this query before; all eight rows must "
            "have the same answer",
            *row->answer, *first->answer);
      (i < 4 ? motion.start : motion.end)[i % 4] = row->point;
    }
    motions.push_back(motion);
    if (first->answer) answers.push_back(*first->answer);
    return true;
  }

 private:
  [[noreturn]] void fail_incomplete(std::size_t rows) const {
    rows_.fail(
        "the file ends after {} of a query; a query has eight rows: four vertices at the start of the step, "
        "then the same vertices at its end",
        counted(rows, "row"));
  }

  RowReader rows_;
};

template <class Motion>
QueryFile read_queries(const fs::path& path) {
  QueryFile file{path, std::vector<Motion>{}, std::nullopt};
  QueryReader<Motion> reader(path);
  std::vector<bool> answers;
  while (reader.read(std::get<std::vector<Motion>>(file.queries), answers)) {
  }
  if (answers.size() == file.size()) file.answers = std::move(answers);
  return file;
}

std::optional<QueryKind> kind_of_folder(const fs::path& path) {
  const fs::path folder = fs::absolute(path).lexically_normal().parent_path();
  std::optional<QueryKind> kind;
  for (const fs::path& name : folder) {
    if (name == "vertex-face") kind = QueryKind::vertex_face;
    if (name == "edge-edge") kind = QueryKind::edge_edge;
  }
  return kind;
}

std::optional<QueryKind> kind_of_stem(const fs::path& path) {
  const std::string stem = path.stem().string();
  if (stem.ends_with("vf")) return QueryKind::vertex_face;
  if (stem.ends_with("ee")) return QueryKind::edge_edge;
  return std::nullopt;
}

/// Accepts a list of true and false, nothing else.
struct AnswerHandler : rapidjson::BaseReaderHandler<rapidjson::UTF8<>, AnswerHandler> {
  std::vector<bool> answers;
  bool in_list = false;

  bool Default() { return false; }
  bool StartArray() { return !std::exchange(in_list, true); }
  bool EndArray(rapidjson::SizeType) { return true; }
  bool Bool(bool answer) {
    if (in_list) answers.push_back(answer);
    return in_list;
  }
};

std::uint64_t line_of(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size()));
  return 1 + static_cast<std::uint64_t>(std::count(text.begin(), end, '\n'));
}

constexpr std::string_view separators = " \t\r,";

/// Calls `add(numbers)` for each line with numbers.
template <std::size_t count, class Add>
void read_lines(const fs::path& path, const char* meaning, const Add& add) {
  std::ifstream file = open_input(path);
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    std::string_view rest = std::string_view(line).substr(0, line.find('#'));
    std::array<double, count> values{};
    std::size_t found = 0;
    for (std::size_t begin; (begin = rest.find_first_not_of(separators)) != std::string_view::npos; ++found) {
      rest.remove_prefix(begin);
      const std::string_view word = rest.substr(0, rest.find_first_of(separators));
      rest.remove_prefix(word.size());
      double value = 0;
      const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (error != std::errc() || end != digits.data() + digits.size())
        fail("{}: line {}: \"{}\" is not a number that a double can hold; a line has {}", path.string(),
             number, word.substr(0, 40), meaning);
      if (found < count) values[found] = value;
    }
    if (found == 0) continue;
    if (found != count) fail("{}: line {}: {} numbers; a line has {}", path.string(), number, found, meaning);
    add(values);
  }
  if (file.bad()) fail("{}: the file cannot be read to its end", path.string());
}

}  // namespace

QueryKind kind_of(const fs::path& path) {
  const std::optional<QueryKind> folder = kind_of_folder(path), stem = kind_of_stem(path);
  if (folder && stem && *folder != *stem)
    fail("{}: the folder and the name give different kinds of queries; give --kind", path.string());
  if (!folder && !stem)
    fail(
        "{}: cannot tell whether these are vertex-face or edge-edge queries; give --kind, or a "
        "folder named after the kind, or a name that ends in vf or ee",
        path.string());
  return folder ? *folder : *stem;
}

QueryFile read_query_file(const fs::path& path, QueryKind kind) {
  return kind == QueryKind::vertex_face ? read_queries<VertexFaceMotion>(path)
                                        : read_queries<EdgeEdgeMotion>(path);
}

void read_answers(const fs::path& path, QueryFile& file) {
  if (file.answers && file.size() > 0)
    fail("{}: already has a column of answers; leave out --answers {}", file.path.string(), path.string());
  const std::string text = read_text(path);
  AnswerHandler handler;
  rapidjson::MemoryStream input(text.data(), text.size());
  const rapidjson::ParseResult parsed =
      rapidjson::Reader().Parse<rapidjson::kParseIterativeFlag>(input, handler);
  const auto fail_there = [&](const std::string& what) {
    fail("{}:{}: {}", path.string(), line_of(text, parsed.Offset()), what);
  };
  if (parsed.Code() == rapidjson::kParseErrorTermination)
    fail_there(handler.in_list ? fmt::format("entry {} must be true or false", handler.answers.size())
                               : "must be a list of true and false, one per query");
  if (!parsed) fail_there(fmt::format("not valid JSON: {}", rapidjson::GetParseError_En(parsed.Code())));
  file.answers = std::move(handler.answers);
  if (file.answers->size() != file.size())
    fail("{}: has {}, but {} has {}; it needs one per query", path.string(),
         counted(file.answers->size(), "answer"), file.path.string(),
         counted(file.size(), "query", "queries"));
}

std::vector<Vec3d> read_points(const fs::path& path) {
  std::vector<Vec3d> points;
  read_lines<3>(path, "three: x, y and z", [&](const auto& v) { points.push_back({v[0], v[1], v[2]}); });
  return points;
}

std::vector<Ray> read_rays(const fs::path& path) {
  std::vector<Ray> rays;
  read_lines<6>(path, "six: x, y and z of the origin, then of the direction", [&](const auto& v) {
    rays.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
  });
  return rays;
}

}  // namespace supple::cli
