#include "option_kinds.hpp"

#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

namespace supple::cli {

namespace {

/// Returns nothing unless the whole text is a finite number.
std::optional<double> parse_number(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [parsed, fault] = std::from_chars(text.data(), end, number);
  if (fault != std::errc{} || parsed != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

std::string flag_of(const char* key) {
  return "--" + spelled(key);
}

std::string spelled(const char* word) {
  std::string text = word;
  std::replace(text.begin(), text.end(), '_', '-');
  return text;
}

bool is_word(const std::string& given, const char* word) {
  return given == word || given == spelled(word);
}

std::string help_of(const char* doc, const std::string& unit, const std::string& default_value) {
  return fmt::format("{} ({}default: {})", doc, unit.empty() ? "" : unit + "; ", default_value);
}

CLI::Option* add_words(CLI::App& app, const std::string& name, std::vector<const char*> choices,
                       std::function<void(std::size_t)> set, const std::string& description) {
  std::vector<std::string> spellings;
  for (const char* word : choices) spellings.push_back(spelled(word));
  const auto parse = [name, choices, spellings, set](const std::string& given) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (is_word(given, choices[i])) return set(i);
    }
    throw CLI::ValidationError(name, fmt::format("'{}' is not one of {}", given, fmt::join(spellings, ", ")));
  };
  return app.add_option_function<std::string>(name, parse, description)
      ->type_name(fmt::format("{}", fmt::join(spellings, "|")));
}

CLI::Option* add_whole(CLI::App& app, const std::string& name, const ValueRange& range,
                       std::function<void(std::uint64_t)> set, const std::string& description) {
  const auto parse = [name, range, set](const std::string& given) {
    std::uint64_t number = 0;
    const char* const end = given.data() + given.size();
    const auto [parsed, fault] = std::from_chars(given.data(), end, number);
    if (fault != std::errc{} || parsed != end || !range.allows(number))
      throw CLI::ValidationError(name, fmt::format("'{}' is not {}", given, text_of(range, true)));
    set(number);
  };
  return app.add_option_function<std::string>(name, parse, description)->type_name("N");
}

CLI::Option* add_real(CLI::App& app, const std::string& name, const ValueRange& range, const char* unit,
                      std::function<void(double)> set, const std::string& description) {
  const auto parse = [name, range, set](const std::string& given) {
    const std::optional<double> number = parse_number(given);
    if (!number || !range.allows(*number))
      throw CLI::ValidationError(name, fmt::format("'{}' is not {}", given, text_of(range, false)));
    set(*number);
  };
  return app.add_option_function<std::string>(name, parse, description)
      ->type_name(std::string(unit) == "s" ? "S" : "D");
}

CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& value,
                      const std::string& description) {
  return app.add_option(name, value, description)->type_name("FILE|-");
}

void check(const Dependences& dependences) {
  for (const Dependence& d : dependences) {
    if (d.option->count() > 0 && !d.satisfied())
      throw CLI::ValidationError(d.option->get_name(), "has no effect without " + d.needs);
  }
}

}  // namespace supple::cli
