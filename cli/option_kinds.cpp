#include "option_kinds.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

namespace supple::cli {

namespace {

/// Nothing when the text is not a finite number and nothing else.
std::optional<double> parse_number(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [parsed, fault] = std::from_chars(text.data(), end, number);
  if (fault != std::errc{} || parsed != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

CLI::Option* add_length(CLI::App& app, const std::string& name, double& value,
                        const std::string& description) {
  const auto parse = [&value, name](const std::string& given) {
    const std::optional<double> number = parse_number(given);
    if (!number || *number < 0)
      throw CLI::ValidationError(name, fmt::format("'{}' is not a finite number from 0 up", given));
    value = *number;
  };
  return app.add_option_function<std::string>(name, parse, description)->type_name("D");
}

CLI::Option* add_seconds(CLI::App& app, const std::string& name, std::optional<double>& value,
                         const std::string& unit, const std::string& description) {
  const auto parse = [&value, name](const std::string& given) {
    value = parse_number(given);
    if (!value || !(*value > 0))
      throw CLI::ValidationError(name, fmt::format("'{}' is not a finite number above 0", given));
  };
  return app.add_option_function<std::string>(name, parse, description)->type_name(unit);
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
