#pragma once

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace supple::cli {

/// An option that takes one of a few words. The first choice is the default.
template <class Enum>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Enum& value,
                        const std::vector<std::pair<std::string, Enum>>& choices,
                        const std::string& description) {
  std::string words, alternatives;
  for (const auto& [word, meaning] : choices) {
    words += (words.empty() ? "" : "|") + word;
    alternatives += (alternatives.empty() ? "" : ", ") + word;
  }
  const auto parse = [&value, choices, alternatives, name](const std::string& given) {
    for (const auto& [word, meaning] : choices) {
      if (word != given) continue;
      value = meaning;
      return;
    }
    throw CLI::ValidationError(name, fmt::format("'{}' is not one of {}", given, alternatives));
  };
  return app
      .add_option_function<std::string>(name, parse,
                                        fmt::format("{} (default: {})", description, choices.front().first))
      ->type_name(words);
}

/// A number from `lowest` to `highest`.
template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& value, std::uint32_t lowest,
                        std::uint32_t highest, const std::string& description) {
  const auto parse = [&value, lowest, highest, name](const std::string& given) {
    std::uint32_t number = 0;
    if (!CLI::detail::lexical_cast(given, number) || number < lowest || number > highest ||
        given.find_first_not_of("0123456789") != std::string::npos)
      throw CLI::ValidationError(
          name, fmt::format("'{}' is not a whole number from {} to {}", given, lowest, highest));
    value = static_cast<Number>(number);
  };
  return app.add_option_function<std::string>(name, parse, description)->type_name("N");
}

/// A finite number ≥ 0.
CLI::Option* add_length(CLI::App& app, const std::string& name, double& value,
                        const std::string& description);

/// A finite number > 0; `unit` stands for it in the help.
CLI::Option* add_seconds(CLI::App& app, const std::string& name, std::optional<double>& value,
                         const std::string& unit, const std::string& description);

/// A file to write, `-` being standard output.
CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& value,
                      const std::string& description);

/// An option that means something only together with a certain choice of another.
struct Dependence {
  const CLI::Option* option;
  std::function<bool()> satisfied;
  std::string needs;
};
using Dependences = std::vector<Dependence>;

/// Throws a usage error about the first option given whose dependence is not satisfied.
void check(const Dependences& dependences);

}  // namespace supple::cli
