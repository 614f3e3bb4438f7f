#include "json_text.hpp"

#include <rapidjson/encodings.h>
#include <rapidjson/memorystream.h>

#include <cmath>

namespace supple::viewer {
namespace {

using Utf8 = rapidjson::UTF8<>;

bool is_utf8(std::string_view text) {
  rapidjson::MemoryStream in(text.data(), text.size());
  unsigned code_point = 0;
  while (in.Tell() < text.size()) {
    if (!Utf8::Decode(in, &code_point)) return false;
  }
  return true;
}

std::string mended(std::string_view text) {
  constexpr unsigned replacement = 0xfffd;
  rapidjson::StringBuffer out;
  for (std::size_t i = 0; i < text.size();) {
    rapidjson::MemoryStream in(text.data() + i, text.size() - i);
    unsigned code_point = 0;
    const bool valid = Utf8::Decode(in, &code_point);
    Utf8::Encode(out, valid ? code_point : replacement);
    i += valid ? in.Tell() : 1;
  }
  return {out.GetString(), out.GetSize()};
}

}  // namespace

void JsonText::clear() {
  buffer_.Clear();
  writer_.Reset(buffer_);
}

void JsonText::value(double number) {
  if (std::isfinite(number))
    writer_.Double(number);
  else
    null();
}

void JsonText::value(std::string_view text) {
  if (is_utf8(text)) {
    writer_.String(text.data(), static_cast<rapidjson::SizeType>(text.size()));
  } else {
    const std::string valid = mended(text);
    writer_.String(valid.data(), static_cast<rapidjson::SizeType>(valid.size()));
  }
}

void JsonText::value(Vec3d point) {
  begin_array();
  value(point.x);
  value(point.y);
  value(point.z);
  end_array();
}

void JsonText::value(std::span<const std::string> texts) {
  begin_array();
  for (const std::string& text : texts) value(text);
  end_array();
}

}  // namespace supple::viewer
