#pragma once

#include <rapidjson/stringbuffer.h>

#include <cmath>
#include <string_view>

#include "json_output.hpp"

namespace supple::viewer {

/// What JSON has no number for becomes null.
struct DoublesOrNull {
  template <class Writer>
  static void write(Writer& writer, double number) {
    if (std::isfinite(number))
      writer.Double(number);
    else
      writer.Null();
  }
};

/// Writes a JSON object as a text.
class JsonText : public JsonOutput<rapidjson::StringBuffer, DoublesOrNull> {
 public:
  JsonText() { begin(buffer_); }

  /// Starts anew, with the memory it has.
  void clear() {
    buffer_.Clear();
    begin(buffer_);
  }
  std::string_view text() const { return {buffer_.GetString(), buffer_.GetSize()}; }

 private:
  rapidjson::StringBuffer buffer_;
};

}  // namespace supple::viewer
