#pragma once

#include <rapidjson/filewritestream.h>
#include <rapidjson/writer.h>

#include <cstdint>
#include <string>
#include <vector>

#include "output_file.hpp"
#include "supple/types.hpp"

namespace supple::cli {

/// Writes JSON to a file as it comes, never holding it in memory. Doubles have the fewest digits that read
/// back to the same bits; what JSON has no number for becomes "nan", "inf" or "-inf".
class JsonWriter {
 public:
  explicit JsonWriter(const std::string& file_name);

  void begin_object() { writer_.StartObject(); }
  void end_object() { writer_.EndObject(); }
  void begin_array() { writer_.StartArray(); }
  void end_array() { writer_.EndArray(); }
  void key(const char* name) { writer_.Key(name); }

  void value(std::uint64_t number) { writer_.Uint64(number); }
  void value(std::int64_t number) { writer_.Int64(number); }
  void value(double number);
  void value(bool truth) { writer_.Bool(truth); }
  void value(const std::string& text);
  /// In ASCII, as names that the program gives are.
  void value(const char* text) { writer_.String(text); }
  void value(Vec3d point);
  void null() { writer_.Null(); }
  /// Two numbers, `[a,b]`.
  void pair(std::uint64_t a, std::uint64_t b);

  template <class Value>
  void member(const char* name, const Value& v) {
    key(name);
    value(v);
  }

  /// Hands on what is buffered; throws `Error` when it could not be written.
  void flush();
  void close();

 private:
  OutputFile file_;
  std::vector<char> buffer_;
  rapidjson::FileWriteStream stream_;
  rapidjson::Writer<rapidjson::FileWriteStream> writer_;
};

}  // namespace supple::cli
