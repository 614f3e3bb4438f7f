// Tables of continuous queries with rational coordinates, their answers, points and rays. The first byte
// chooses the reader.

#include <string>

#include "query/query_file.hpp"
#include "query/rational.hpp"
#include "supple/error.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/temporary_file.hpp"

namespace {

using namespace supple;
using fuzz::check;

/// Compares the two ways to read a quotient. The text has both numbers, with a comma between them.
void compare_quotients(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.size() > 200) return;
  const std::string_view above = text.substr(0, comma), below = text.substr(comma + 1);
  const auto quick = cli::exact_small_quotient(above, below);
  if (!quick) return;
  const auto numerator = cli::parse_integer(above), denominator = cli::parse_integer(below);
  check(numerator && denominator && *denominator != 0, "only one way reads the quotient");
  // Boost refuses negative denominators.
  const cli::Integer sign = *denominator < 0 ? -1 : 1;
  check(cli::exact_double(cli::Rational(sign * *numerator, sign * *denominator)) == quick,
        "two values of one quotient");
}

void read(std::uint32_t choice, const std::filesystem::path& path) {
  switch (choice) {
    case 0:
    case 1: {
      const auto kind = choice == 0 ? cli::QueryKind::vertex_face : cli::QueryKind::edge_edge;
      const cli::QueryFile file = cli::read_query_file(path, kind);
      check(!file.answers || file.answers->size() == file.size(), "not one answer for each query");
      return;
    }
    case 2: {
      cli::QueryFile file{path, std::vector<EdgeEdgeMotion>(3), {}};
      cli::read_answers(path, file);
      check(file.answers && file.answers->size() == 3, "not one answer for each query");
      return;
    }
    case 3:
      cli::read_points(path);
      return;
    default:
      cli::read_rays(path);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteReader bytes(data, size);
  const std::uint32_t choice = bytes.byte() % 6;
  if (choice == 5) {
    compare_quotients(bytes.text());
    return 0;
  }
  static const fuzz::TemporaryFile file(".csv");
  file.write(bytes.text());
  try {
    read(choice, file.path());
  } catch (const Error& error) {
    fuzz::check_message(error.what(), file.path().string());
  }
  return 0;
}
