#include "options/option_kinds.hpp"

#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace supple::cli {

std::optional<double> parse_number(std::string_view text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [parsed, fault] = std::from_chars(text.data(), end, number);
  if (fault != std::errc{} || parsed != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

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

std::size_t index_of_word(const std::string& name, const std::vector<const char*>& choices,
                          const std::string& given) {
  std::vector<std::string> spellings;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (is_word(given, choices[i])) return i;
    spellings.push_back(spelled(choices[i]));
  }
  throw CLI::ValidationError(name, fmt::format("'{}' is not one of {}", given, fmt::join(spellings, ", ")));
}

std::uint64_t whole_of(const std::string& name, const ValueRange& range, const std::string& given) {
  std::uint64_t number = 0;
  const char* const end = given.data() + given.size();
  const auto [parsed, fault] = std::from_chars(given.data(), end, number);
  if (fault != std::errc{} || parsed != end || !range.allows(number))
    throw CLI::ValidationError(name, fmt::format("'{}' is not {}", given, text_of(range, true)));
  return number;
}

double real_of(const std::string& name, const ValueRange& range, const std::string& given) {
  const std::optional<double> number = parse_number(given);
  if (!number || !range.allows(*number))
    throw CLI::ValidationError(name, fmt::format("'{}' is not {}", given, text_of(range, false)));
  return *number;
}

CLI::Option* add_words(CLI::App& app, const std::string& name, std::vector<const char*> choices,
                       std::function<void(std::size_t)> set, const std::string& description) {
  std::vector<std::string> spellings;
  for (const char* word : choices) spellings.push_back(spelled(word));
  const auto parse = [name, choices, set](const std::string& given) {
    set(index_of_word(name, choices, given));
  };
  return app.add_option_function<std::string>(name, parse, description)
      ->type_name(fmt::format("{}", fmt::join(spellings, "|")));
}

CLI::Option* add_whole(CLI::App& app, const std::string& name, const ValueRange& range,
                       std::function<void(std::uint64_t)> set, const std::string& description) {
  const auto parse = [name, range, set](const std::string& given) { set(whole_of(name, range, given)); };
  return app.add_option_function<std::string>(name, parse, description)->type_name("N");
}

CLI::Option* add_real(CLI::App& app, const std::string& name, const ValueRange& range, const char* unit,
                      std::function<void(double)> set, const std::string& description) {
  const auto parse = [name, range, set](const std::string& given) { set(real_of(name, range, given)); };
  return app.add_option_function<std::string>(name, parse, description)
      ->type_name(std::string(unit) == "s" ? "S" : "D");
}

CLI::Option* add_list(CLI::App& app, const std::string& name, std::function<void(const std::string&)> add,
                      const std::string& description) {
  const auto parse = [name, add](const std::vector<std::string>& given) {
    std::vector<std::string> values;
    for (const std::string& list : given) {
      std::istringstream stream(list + ',');
      for (std::string value; std::getline(stream, value, ',');) {
        if (std::find(values.begin(), values.end(), value) != values.end())
          throw CLI::ValidationError(name, fmt::format("'{}' is given twice", value));
        values.push_back(value);
        add(value);
      }
    }
  };
  return app.add_option_function<std::vector<std::string>>(name, parse, description)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
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

CLI::Option* add_root(CLI::App& app, const char* key, bool& root_is_border,
                      std::function<void(const RootCube&)> set) {
  constexpr const char* description =
      "Root region of the scene octree, a cube: its lowest corner and its edge, or the cube around the "
      "border of the scene (length; default: fitted to the objects)";
  const std::string name = flag_of(key);
  const auto parse = [name, &root_is_border, set](const std::string& given) {
    root_is_border = given == "border";
    if (root_is_border) return;
    const std::optional<std::array<double, 4>> numbers = parse_numbers<4>(given);
    const RootCube cube =
        numbers ? RootCube{{(*numbers)[0], (*numbers)[1], (*numbers)[2]}, (*numbers)[3]} : RootCube{};
    if (!is_valid(cube))
      throw CLI::ValidationError(
          name, fmt::format("'{}' is not X,Y,Z,EDGE, {}, nor border", given, range_of_root_cube));
    set(cube);
  };
  return app.add_option_function<std::string>(name, parse, description)->type_name("X,Y,Z,EDGE|border");
}

}  // namespace supple::cli
