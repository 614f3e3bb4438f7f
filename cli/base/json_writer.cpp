#include "base/json_writer.hpp"

#include <fmt/core.h>

#include <cmath>

#include "supple/version.hpp"

namespace supple::cli {

void DoublesOrWords::write(rapidjson::Writer<rapidjson::FileWriteStream>& writer, double number) {
  if (!std::isfinite(number)) {
    writer.String(std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf");
    return;
  }
  char digits[32];
  const auto end = fmt::format_to_n(digits, sizeof digits, "{}", number);
  writer.RawValue(digits, end.size, rapidjson::kNumberType);
}

JsonWriter::JsonWriter(const std::string& file_name)
    : file_(file_name), buffer_(1 << 16), stream_(file_.stream(), buffer_.data(), buffer_.size()) {
  begin(stream_);
  begin_object();
  member("supple", SUPPLE_VERSION);
}

void JsonWriter::flush() {
  stream_.Flush();
  file_.check();
}

void JsonWriter::close() {
  end_object();
  stream_.Put('\n');
  stream_.Flush();
  file_.close();
}

}  // namespace supple::cli
