#pragma once

#include <ostream>
#include <vector>

#include "supple/option_descriptions.hpp"

namespace supple {

/// The value of an option as a parameter of a test. GoogleTest and ctest show its word; they would show the
/// bytes of a plain enumeration.
template <Worded Enum>
struct OptionWord {
  OptionWord(Enum of) : value(of) {}
  operator Enum() const { return value; }

  Enum value;
};

/// GoogleTest calls this function.
template <Worded Enum>
void PrintTo(const OptionWord<Enum>& option, std::ostream* out) {
  *out << word_of(option.value);
}

template <class Values>
auto option_words(const Values& values) {
  return std::vector<OptionWord<typename Values::value_type>>(values.begin(), values.end());
}

}  // namespace supple
