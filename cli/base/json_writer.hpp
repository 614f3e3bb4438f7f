#pragma once

#include <rapidjson/filewritestream.h>

#include <string>
#include <vector>

#include "base/output_file.hpp"
#include "session/messages/json_output.hpp"

namespace supple::cli {

/// Writes the fewest digits that read back to the same bits, or "nan", "inf" or "-inf".
struct DoublesOrWords {
  static void write(rapidjson::Writer<rapidjson::FileWriteStream>& writer, double number);
};

/// Streams JSON to a file without holding it in memory.
class JsonWriter : public viewer::JsonOutput<rapidjson::FileWriteStream, DoublesOrWords> {
 public:
  explicit JsonWriter(const std::string& file_name);

  /// Writes the buffer to the file. Throws `Error` when that fails.
  void flush();
  void close();

 private:
  OutputFile file_;
  std::vector<char> buffer_;
  rapidjson::FileWriteStream stream_;
};

}  // namespace supple::cli
