#include "query/query_file.hpp"

#include <array>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "base/files.hpp"
#include "base/text.hpp"

namespace supple::cli {
namespace {

constexpr std::string_view separators = " \t\r,";

/// Calls `add(numbers)` for each line with numbers.
template <std::size_t count, class Add>
void read_lines(const std::filesystem::path& path, const char* meaning, const Add& add) {
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

std::vector<Vec3d> read_points(const std::filesystem::path& path) {
  std::vector<Vec3d> points;
  read_lines<3>(path, "three: x, y and z", [&](const auto& v) { points.push_back({v[0], v[1], v[2]}); });
  return points;
}

std::vector<Ray> read_rays(const std::filesystem::path& path) {
  std::vector<Ray> rays;
  read_lines<6>(path, "six: x, y and z of the origin, then of the direction", [&](const auto& v) {
    rays.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
  });
  return rays;
}

}  // namespace supple::cli
