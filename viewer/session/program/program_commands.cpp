#include "program_commands.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "attach_descriptions.hpp"

namespace supple::viewer {
namespace {

bool is_given(const char* name, Arguments& arguments) {
  const JsonValue* const value = arguments.member(name);
  return value != nullptr && value->kind != JsonValue::Kind::null;
}

void read_objects(Arguments& arguments, std::array<std::string, 2>& objects) {
  if (!is_given("objects", arguments)) return;
  const JsonValue& list = *arguments.member("objects");
  bool is_valid = list.kind == JsonValue::Kind::list && list.elements.size() == objects.size();
  for (std::size_t i = 0; is_valid && i < objects.size(); ++i) {
    is_valid = list.elements[i].kind == JsonValue::Kind::text;
    objects[i] = list.elements[i].text;
  }
  if (!is_valid) arguments.must_be("objects", "two names of objects, or empty texts for any object");
}

}  // namespace

BreakOptions read_breaks(Arguments& arguments) {
  BreakOptions breaks;
  for_each_field<BreakOptions>([&]<class Value>(const Field<BreakOptions, Value>& field) {
    Value& value = breaks.*field.member;
    if (!is_given(field.key, arguments)) return;
    if constexpr (std::is_same_v<Value, bool>) {
      value = arguments.boolean(field.key).value_or(false);
    } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
      value = arguments.number(field.key, field.range);
    } else if (const auto count = arguments.integer(field.key, field.range)) {
      value = static_cast<std::uint64_t>(*count);
    }
  });
  read_objects(arguments, breaks.objects);
  return breaks;
}

void write_breaks(const BreakOptions& breaks, JsonText& json) {
  json.key("breaks");
  json.begin_array();
  for_each_field<BreakOptions>([&]<class Value>(const Field<BreakOptions, Value>& field) {
    json.begin_object();
    json.member("key", field.key);
    json.member("doc", field.doc);
    json.member("unit", field.unit);
    json.member("kind", std::is_same_v<Value, bool> ? "truth" : "number");
    json.key("value");
    const Value& value = breaks.*field.member;
    if constexpr (std::is_same_v<Value, bool>) {
      json.value(value);
    } else if (value) {
      json.value(*value);
    } else {
      json.null();
    }
    json.end_object();
  });
  json.end_array();
  json.member("break_objects", std::span<const std::string>(breaks.objects));
}

void answer_program(const ProgramState& state, JsonText& json) {
  json.member("steps", state.step_count);
  json.member("step", state.last_step);
  json.member("runs", state.runs);
  json.member("seconds_since_step", state.seconds_since_step);
}

}  // namespace supple::viewer
