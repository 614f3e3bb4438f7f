#include "utf8.hpp"

#include <rapidjson/encodings.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/stringbuffer.h>

namespace supple::viewer {

std::string valid_utf8(std::string_view text) {
  using Utf8 = rapidjson::UTF8<>;
  constexpr unsigned replacement = 0xfffd;
  rapidjson::StringBuffer valid;
  while (!text.empty()) {
    rapidjson::MemoryStream in(text.data(), text.size());
    unsigned code_point = 0;
    const bool is_valid = Utf8::Decode(in, &code_point);
    Utf8::Encode(valid, is_valid ? code_point : replacement);
    text.remove_prefix(is_valid ? in.Tell() : 1);
  }
  return {valid.GetString(), valid.GetSize()};
}

}  // namespace supple::viewer
