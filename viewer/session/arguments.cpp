#include "arguments.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "messages/json_text.hpp"

namespace supple::viewer {
namespace {

std::string number_text(double value) {
  JsonText json;
  json.value(value);
  std::string text(json.text());
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

/// The JSON text of the value, shortened when it is long.
std::string text_of(const JsonValue& value) {
  constexpr std::size_t longest = 40;
  switch (value.kind) {
    case JsonValue::Kind::null:
      return "null";
    case JsonValue::Kind::boolean:
      return value.truth ? "true" : "false";
    case JsonValue::Kind::integer:
      return std::to_string(value.integer);
    case JsonValue::Kind::number:
      return number_text(value.number);
    case JsonValue::Kind::text:
      return '"' + (value.text.size() > longest ? value.text.substr(0, longest) + "…" : value.text) + '"';
    case JsonValue::Kind::list:
      return "a list";
    case JsonValue::Kind::object:
      break;
  }
  return "an object";
}

bool is_list_of(const JsonValue& value, bool (JsonValue::*is_wanted)() const) {
  return value.kind == JsonValue::Kind::list &&
         std::all_of(value.elements.begin(), value.elements.end(),
                     [is_wanted](const JsonValue& element) { return (element.*is_wanted)(); });
}

std::uint32_t id_of(const JsonValue& value) {
  return static_cast<std::uint32_t>(value.integer);
}

}  // namespace

std::optional<bool> Arguments::boolean(const char* name) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->kind == JsonValue::Kind::boolean) return value->truth;
  must_be(name, "true or false");
  return std::nullopt;
}

std::optional<std::int64_t> Arguments::integer(const char* name, std::int64_t low, std::int64_t high) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->kind == JsonValue::Kind::integer && value->integer >= low && value->integer <= high)
    return value->integer;
  must_be(name, high < largest_id
                    ? "a whole number from " + std::to_string(low) + " to " + std::to_string(high)
                    : "a whole number, at least " + std::to_string(low));
  return std::nullopt;
}

std::optional<double> Arguments::number(const char* name, double low, double high) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_number() && value->number >= low && value->number <= high) return value->number;
  must_be(name, "a number from " + number_text(low) + " to " + number_text(high));
  return std::nullopt;
}

std::optional<std::int64_t> Arguments::integer(const char* name, const ValueRange& range) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->kind == JsonValue::Kind::integer && value->integer >= 0 &&
      range.allows(static_cast<std::uint64_t>(value->integer)))
    return value->integer;
  must_be(name, text_of(range, true));
  return std::nullopt;
}

std::optional<double> Arguments::number(const char* name, const ValueRange& range) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_number() && range.allows(value->number)) return value->number;
  must_be(name, text_of(range, false));
  return std::nullopt;
}

std::optional<std::uint64_t> Arguments::digits(const char* name) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  std::uint64_t number = 0;
  const char* const end = value->text.data() + value->text.size();
  if (value->kind == JsonValue::Kind::text) {
    const auto [rest, error] = std::from_chars(value->text.data(), end, number);
    if (error == std::errc() && rest == end) return number;
  }
  must_be(name, "a whole number from 0 to 18446744073709551615, as a text");
  return std::nullopt;
}

std::optional<bool> Arguments::one_of_two(const char* name,
                                          const std::array<const char*, 2>& words_of_truth) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->kind == JsonValue::Kind::text) {
    if (value->text == words_of_truth[0]) return false;
    if (value->text == words_of_truth[1]) return true;
  }
  must_be(name, std::string("one of ") + words_of_truth[0] + ", " + words_of_truth[1]);
  return std::nullopt;
}

std::optional<Vec3d> Arguments::point(const char* name) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (is_list_of(*value, &JsonValue::is_number) && value->elements.size() == 3)
    return Vec3d{value->elements[0].number, value->elements[1].number, value->elements[2].number};
  must_be(name, "three numbers");
  return std::nullopt;
}

std::optional<std::optional<RootCube>> Arguments::cube(const char* name) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->kind == JsonValue::Kind::null) return std::optional<RootCube>();
  if (is_list_of(*value, &JsonValue::is_number) && value->elements.size() == 4) {
    const auto number = [&](std::size_t i) { return value->elements[i].number; };
    const RootCube cube{{number(0), number(1), number(2)}, number(3)};
    if (is_valid(cube)) return cube;
  }
  must_be(name, std::string("null, or ") + range_of_root_cube);
  return std::nullopt;
}

std::optional<std::array<std::uint32_t, 2>> Arguments::pair(const char* name) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (is_list_of(*value, &JsonValue::is_id) && value->elements.size() == 2)
    return std::array{id_of(value->elements[0]), id_of(value->elements[1])};
  must_be(name, "the numbers of an object and one of its triangles");
  return std::nullopt;
}

std::optional<std::vector<std::uint32_t>> Arguments::numbers(const char* name) {
  const JsonValue* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!is_list_of(*value, &JsonValue::is_id)) {
    must_be(name, "a list of whole numbers");
    return std::nullopt;
  }
  std::vector<std::uint32_t> numbers;
  for (const JsonValue& element : value->elements) numbers.push_back(id_of(element));
  return numbers;
}

void Arguments::must_be(const char* name, const std::string& what) {
  fail(std::string(name) + " is " + text_of(*find(name)) + "; it must be " + what);
}

void Arguments::fail(std::string error) {
  if (error_.empty()) error_ = command_ + ": " + std::move(error);
}

bool Arguments::check() {
  for (const std::string& name : object_.names) {
    if (name == "do" || name == "id" || std::find(known_.begin(), known_.end(), name) != known_.end())
      continue;
    std::string list;
    for (const std::string_view known : known_) list += (list.empty() ? "" : ", ") + std::string(known);
    fail("it has no \"" + name.substr(0, 40) + "\"; " +
         (known_.empty() ? "it takes no other members" : "it takes " + list));
  }
  return error_.empty();
}

const JsonValue* Arguments::find(const char* name) {
  if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
  return object_.find(name);
}

}  // namespace supple::viewer
