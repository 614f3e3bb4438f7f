#include "json_writer.hpp"

#include <fmt/core.h>

#include <cmath>

#include "text.hpp"

namespace supple::cli {

JsonWriter::JsonWriter(const std::string& file_name)
    : file_(file_name),
      buffer_(1 << 16),
      stream_(file_.stream(), buffer_.data(), buffer_.size()),
      writer_(stream_) {}

void JsonWriter::value(double number) {
  if (!std::isfinite(number)) {
    value(std::string(std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf"));
    return;
  }
  char digits[32];
  const auto end = fmt::format_to_n(digits, sizeof digits, "{}", number);
  writer_.RawValue(digits, end.size, rapidjson::kNumberType);
}

void JsonWriter::value(const std::string& text) {
  const std::string valid = valid_utf8(text);
  writer_.String(valid.data(), static_cast<rapidjson::SizeType>(valid.size()));
}

void JsonWriter::value(Vec3d point) {
  writer_.StartArray();
  value(point.x);
  value(point.y);
  value(point.z);
  writer_.EndArray();
}

void JsonWriter::pair(std::uint64_t a, std::uint64_t b) {
  writer_.StartArray();
  writer_.Uint64(a);
  writer_.Uint64(b);
  writer_.EndArray();
}

void JsonWriter::flush() {
  stream_.Flush();
  file_.check();
}

void JsonWriter::close() {
  stream_.Put('\n');
  stream_.Flush();
  file_.close();
}

}  // namespace supple::cli
