#pragma once

#include <rapidjson/stringbuffer.h>

#include <cmath>
#include <string_view>

#include "messages/json_output.hpp"

namespace supple::viewer {

/// Writes null for NaN and infinity.
struct DoublesOrNull {
  template <class Writer>
  static void write(Writer& writer, double number) {
    if (std::isfinite(number))
      writer.Double(number);
    else
      writer.Null();
  }
};

/// Writes one JSON object to a string.
class JsonText : public JsonOutput<rapidjson::StringBuffer, DoublesOrNull> {
 public:
  JsonText() { begin(buffer_); }

  /// Starts again and keeps the allocated memory.
  void clear() {
    buffer_.Clear();
    begin(buffer_);
  }
  std::string_view text() const { return {buffer_.GetString(), buffer_.GetSize()}; }

 private:
  rapidjson::StringBuffer buffer_;
};

}  // namespace supple::viewer
