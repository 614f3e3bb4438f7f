#pragma once

#include <fmt/core.h>
#include <rapidjson/filewritestream.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "session/messages/json_output.hpp"
#include "supple/version.hpp"

namespace supple::cli {

/// Writes the fewest digits that read back to the same bits, or "nan", "inf" or "-inf".
struct DoublesOrWords {
  static void write(rapidjson::Writer<rapidjson::FileWriteStream>& writer, double number) {
    if (!std::isfinite(number)) {
      writer.String(std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf");
      return;
    }
    char digits[32];
    const auto end = fmt::format_to_n(digits, sizeof digits, "{}", number);
    writer.RawValue(digits, end.size, rapidjson::kNumberType);
  }
};

/// Streams a JSON object to a file without holding it in memory. Its first member is the version.
class JsonWriter : public viewer::JsonOutput<rapidjson::FileWriteStream, DoublesOrWords> {
 public:
  explicit JsonWriter(const std::string& file_name)
      : file_(file_name), buffer_(1 << 16), stream_(file_.stream(), buffer_.data(), buffer_.size()) {
    begin(stream_);
    begin_object();
    member("supple", SUPPLE_VERSION);
  }

  using JsonOutput::member;
  /// Null when there is no value.
  template <class Value>
  void member(const char* name, const std::optional<Value>& v) {
    key(name);
    v ? value(*v) : null();
  }
  /// Writes an array of these values.
  template <class... Values>
  void row(const Values&... values) {
    begin_array();
    (value(values), ...);
    end_array();
  }
  /// `write()` writes the members of the object.
  template <class Write>
  void object(const char* name, const Write& write) {
    key(name);
    begin_object();
    write();
    end_object();
  }
  /// `write(item)` writes each item of the array.
  template <class Items, class Write>
  void array(Items&& items, const Write& write) {
    begin_array();
    for (const auto& item : items) write(item);
    end_array();
  }
  template <class Items, class Write>
  void list(const char* name, Items&& items, const Write& write) {
    key(name);
    array(items, write);
  }
  template <class Items>
  void list(const char* name, Items&& items) {
    list(name, items, [this](const auto& item) { this->value(item); });
  }
  /// `write(item)` writes the members of an object for each item.
  template <class Items, class Write>
  void objects(const char* name, Items&& items, const Write& write) {
    list(name, items, [&](const auto& item) {
      begin_object();
      write(item);
      end_object();
    });
  }

  /// Writes the buffer to the file. Throws `Error` when that fails.
  void flush() {
    stream_.Flush();
    file_.check();
  }
  /// Ends the object.
  void close() {
    end_object();
    stream_.Put('\n');
    stream_.Flush();
    file_.close();
  }

 private:
  OutputFile file_;
  std::vector<char> buffer_;
  rapidjson::FileWriteStream stream_;
};

}  // namespace supple::cli
