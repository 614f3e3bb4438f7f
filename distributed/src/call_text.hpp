#pragma once

#include <string>
#include <type_traits>

#include "supple/option_descriptions.hpp"
#include "supple/utf8.hpp"

namespace supple {

/// The arguments of a collective call as lines `name is value`, by which ranks compare their calls.
class CallText {
 public:
  explicit CallText(const char* call) { add("call", std::string(call)); }

  template <class Value>
  CallText& add(const char* name, const Value& value) {
    text_ += std::string(name) + " is " + text(value) + "\n";
    return *this;
  }
  /// All options but those of the machine.
  template <Described Options>
  CallText& add_options(const Options& options) {
    for_each_leaf(
        [&](const auto& field, const auto& value) {
          if (!field.is_of_machine) add(field.key, value);
        },
        options);
    return *this;
  }
  operator std::string() const { return text_; }

 private:
  template <class Value>
  static std::string text(const Value& value) {
    if constexpr (std::is_same_v<Value, std::string>) {
      return one_line(value);
    } else if constexpr (std::is_same_v<Value, ObjectId>) {
      return std::to_string(value.index) + " (generation " + std::to_string(value.generation) + ")";
    } else if constexpr (Worded<Value>) {
      return word_of(value);
    } else if constexpr (std::is_integral_v<Value>) {
      return std::to_string(value);
    } else if constexpr (requires { value.has_value(); }) {
      return value ? text(*value) : "none";
    } else {
      return text_of(value);
    }
  }

  std::string text_;
};

}  // namespace supple
