#pragma once

#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "supple/types.hpp"

namespace supple::viewer {

/// Writes a JSON object as a text. What JSON has no number for becomes null; what is no UTF-8 in a text
/// becomes U+FFFD.
class JsonText {
 public:
  JsonText() : writer_(buffer_) {}

  /// Starts anew, with the memory it has.
  void clear();
  std::string_view text() const { return {buffer_.GetString(), buffer_.GetSize()}; }

  void begin_object() { writer_.StartObject(); }
  void end_object() { writer_.EndObject(); }
  void begin_array() { writer_.StartArray(); }
  void end_array() { writer_.EndArray(); }
  void key(const char* name) { writer_.Key(name); }

  void value(std::uint64_t number) { writer_.Uint64(number); }
  void value(std::uint32_t number) { writer_.Uint(number); }
  void value(double number);
  void value(bool truth) { writer_.Bool(truth); }
  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void value(const std::string& text) { value(std::string_view(text)); }
  void value(Vec3d point);
  void value(std::span<const std::string> texts);
  void null() { writer_.Null(); }

  template <class Value>
  void member(const char* name, const Value& v) {
    key(name);
    value(v);
  }

 private:
  rapidjson::StringBuffer buffer_;
  rapidjson::Writer<rapidjson::StringBuffer> writer_;
};

}  // namespace supple::viewer
