#pragma once

#include <rapidjson/rapidjson.h>
#include <rapidjson/writer.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "supple/comparison_options.hpp"
#include "supple/types.hpp"
#include "supple/utf8.hpp"

namespace supple::viewer {

/// Writes JSON to a RapidJSON stream. All JSON of the program uses it. Bytes that are not valid UTF-8 become
/// U+FFFD. `Doubles::write(writer, number)` formats doubles and replaces those that JSON cannot express.
template <class Stream, class Doubles>
class JsonOutput {
 public:
  void begin_object() { writer_.StartObject(); }
  void end_object() { writer_.EndObject(); }
  void begin_array() { writer_.StartArray(); }
  void end_array() { writer_.EndArray(); }
  void key(const char* name) { writer_.Key(name); }

  void value(std::uint64_t number) { writer_.Uint64(number); }
  void value(std::uint32_t number) { writer_.Uint(number); }
  void value(std::int64_t number) { writer_.Int64(number); }
  void value(double number) { Doubles::write(writer_, number); }
  void value(bool truth) { writer_.Bool(truth); }
  void value(std::string_view text) {
    // ASCII is valid as it is, and frames must not allocate memory.
    const bool is_ascii = std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
    const std::string valid = is_ascii ? std::string() : valid_utf8(text);
    if (!is_ascii) text = valid;
    writer_.String(text.data(), static_cast<rapidjson::SizeType>(text.size()));
  }
  void value(const std::string& text) { value(std::string_view(text)); }
  void value(const char* text) { value(std::string_view(text)); }
  void value(Vec3d point) {
    begin_array();
    value(point.x);
    value(point.y);
    value(point.z);
    end_array();
  }
  void value(const std::optional<RootCube>& cube) {
    if (!cube) return null();
    begin_array();
    for (int axis = 0; axis < 3; ++axis) value(cube->corner[axis]);
    value(cube->edge);
    end_array();
  }
  void value(std::span<const std::string> texts) {
    begin_array();
    for (const std::string& text : texts) value(text);
    end_array();
  }
  void null() { writer_.Null(); }
  /// Writes an array of two numbers, `[a,b]`.
  void pair(std::uint64_t a, std::uint64_t b) {
    begin_array();
    value(a);
    value(b);
    end_array();
  }

  template <class Value>
  void member(const char* name, const Value& v) {
    key(name);
    value(v);
  }

 protected:
  using Writer = rapidjson::Writer<Stream>;

  /// Starts a new text and keeps the allocated memory.
  void begin(Stream& stream) { writer_.Reset(stream); }

 private:
  Writer writer_;
};

}  // namespace supple::viewer
