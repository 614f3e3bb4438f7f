#include "base/output_names.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>

#include "supple/error.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

/// Whether both are one regular file, or will be one. Devices such as /dev/null can be shared.
bool are_one_file(const fs::path& a, const fs::path& b) {
  std::error_code fault;
  if (fs::exists(a, fault) && fs::exists(b, fault))
    return fs::is_regular_file(a, fault) && fs::equivalent(a, b, fault);
  const fs::path path_a = fs::weakly_canonical(fs::absolute(a, fault), fault);
  const fs::path path_b = fs::weakly_canonical(fs::absolute(b, fault), fault);
  return !path_a.empty() && path_a == path_b;
}

}  // namespace

void check_output_names(std::initializer_list<OutputName> outputs, std::span<const fs::path> inputs) {
  for (const OutputName& output : outputs) {
    if (output.name.empty() || output.name == "-") continue;
    if (std::any_of(inputs.begin(), inputs.end(),
                    [&](const fs::path& input) { return are_one_file(input, output.name); }))
      throw Error(fmt::format("{}: {} is an input; choose another file", output.option, output.name));
    for (const OutputName& other : outputs) {
      if (&other == &output) break;
      if (!other.name.empty() && other.name != "-" && are_one_file(other.name, output.name))
        throw Error(fmt::format("{}: {} already writes {}; choose another file", output.option, other.option,
                                output.name));
    }
  }
}

}  // namespace supple::cli
