#pragma once

#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "messages/message.hpp"
#include "session.hpp"
#include "support/check.hpp"

namespace supple::fuzz {

/// Checks a message as a page does (viewer/PROTOCOL.md).
inline void check_session_message(std::span<const std::byte> message) {
  const auto word = [&](std::size_t place) {
    check(place + 4 <= message.size(), "a message ends early");
    std::uint32_t value = 0;
    std::memcpy(&value, message.data() + place, sizeof value);
    return value;
  };
  check(word(0) == 0x4c505553 && word(8) == message.size() && message.size() % 16 == 0, "a header is wrong");
  std::size_t place = 16;
  for (std::uint32_t sections = word(12); sections > 0; --sections) {
    const std::size_t data = place + 16, length = word(place + 12);
    check(data + length <= message.size(), "a section ends behind its message");
    if (word(place) == static_cast<std::uint32_t>(viewer::Tag::text)) {
      const char* const text = reinterpret_cast<const char*>(message.data() + data);
      rapidjson::MemoryStream stream(text, length);
      rapidjson::BaseReaderHandler<> ignore;
      check(length > 0 && text[0] == '{', "a text is not a JSON object");
      check(rapidjson::Reader().Parse<rapidjson::kParseValidateEncodingFlag>(stream, ignore),
            "a text is not JSON");
    }
    place = data + (length + 15) / 16 * 16;
  }
  check(place == message.size(), "a message has bytes behind its sections");
}

/// Reads all messages that wait.
inline void drain(viewer::Session& session, viewer::MessageWriter& writer) {
  for (auto message = session.next_message(writer); !message.empty(); message = session.next_message(writer))
    check_session_message(message);
}

}  // namespace supple::fuzz
