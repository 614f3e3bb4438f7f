#include "messages/message.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace supple::viewer {
namespace {

constexpr std::uint32_t magic = 0x4c505553;  // SUPL
constexpr std::uint32_t version = 2;

using Words = std::array<std::uint32_t, 4>;

}  // namespace

void MessageWriter::begin(MessageKind kind) {
  kind_ = kind;
  used_ = 0;
  section_count_ = 0;
  append(sizeof(Words));
}

void MessageWriter::add_text(std::string_view json) {
  const std::span<char> text = add<char>(Tag::text, json.size());
  std::copy(json.begin(), json.end(), text.begin());
}

std::span<const std::byte> MessageWriter::finish() {
  const std::size_t length = used_ * alignment;
  const Words header{magic, version | static_cast<std::uint32_t>(kind_) << 16,
                     static_cast<std::uint32_t>(length), section_count_};
  std::memcpy(blocks_.front().bytes, header.data(), sizeof(header));
  return {blocks_.front().bytes, length};
}

std::byte* MessageWriter::add_section(Tag tag, std::uint32_t object, std::size_t count, std::size_t length) {
  ++section_count_;
  const Words header{static_cast<std::uint32_t>(tag), object, static_cast<std::uint32_t>(count),
                     static_cast<std::uint32_t>(length)};
  std::memcpy(append(sizeof(header)), header.data(), sizeof(header));
  return append(length);
}

/// Reserves `length` bytes and adds zeros up to the next block.
std::byte* MessageWriter::append(std::size_t length) {
  const std::size_t first = used_;
  used_ += (length + alignment - 1) / alignment;
  // One extra block, so that the end has a valid address.
  if (blocks_.size() <= used_) blocks_.resize(std::max(used_ + 1, blocks_.size() + blocks_.size() / 2));
  std::byte* const data = blocks_[first].bytes;
  std::memset(data + length, 0, (used_ - first) * alignment - length);
  return data;
}

}  // namespace supple::viewer
