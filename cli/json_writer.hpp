#pragma once

#include <rapidjson/filewritestream.h>

#include <string>
#include <vector>

#include "output_file.hpp"
#include "session/json_output.hpp"

namespace supple::cli {

/// With the fewest digits that read back to the same bits; what JSON has no number for becomes "nan", "inf"
/// or "-inf".
struct DoublesOrWords {
  static void write(rapidjson::Writer<rapidjson::FileWriteStream>& writer, double number);
};

/// Writes JSON to a file as it comes, never holding it in memory.
class JsonWriter : public viewer::JsonOutput<rapidjson::FileWriteStream, DoublesOrWords> {
 public:
  explicit JsonWriter(const std::string& file_name);

  /// Hands on what is buffered; throws `Error` when it could not be written.
  void flush();
  void close();

 private:
  OutputFile file_;
  std::vector<char> buffer_;
  rapidjson::FileWriteStream stream_;
};

}  // namespace supple::cli
