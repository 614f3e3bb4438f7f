#include "messages/json_value.hpp"

#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <algorithm>
#include <utility>

namespace supple::viewer {
namespace {

constexpr std::size_t deepest = 16;

/// Receives the events of the RapidJSON reader. Each function returns whether to continue.
class Builder : public rapidjson::BaseReaderHandler<rapidjson::UTF8<>, Builder> {
 public:
  using Kind = JsonValue::Kind;
  using Size = rapidjson::SizeType;

  JsonValue take() { return std::move(root_); }

  bool Null() { return add({}) != nullptr; }
  bool Bool(bool truth) { return add({.kind = Kind::boolean, .truth = truth}) != nullptr; }
  bool Int(int value) { return Int64(value); }
  bool Uint(unsigned value) { return Int64(value); }
  bool Int64(std::int64_t value) {
    return add({.kind = Kind::integer, .integer = value, .number = static_cast<double>(value)}) != nullptr;
  }
  bool Uint64(std::uint64_t value) { return Double(static_cast<double>(value)); }
  bool Double(double value) { return add({.kind = Kind::number, .number = value}) != nullptr; }
  bool String(const char* text, Size length, bool) {
    return add({.kind = Kind::text, .text = {text, length}}) != nullptr;
  }
  bool Key(const char* text, Size length, bool) {
    open_.back()->names.emplace_back(text, length);
    return true;
  }
  bool StartObject() { return open(Kind::object); }
  bool StartArray() { return open(Kind::list); }
  bool EndObject(Size) { return close(); }
  bool EndArray(Size) { return close(); }

 private:
  JsonValue* add(JsonValue value) {
    JsonValue& place = open_.empty() ? root_ : open_.back()->elements.emplace_back();
    place = std::move(value);
    return &place;
  }
  bool open(Kind kind) {
    if (open_.size() == deepest) return false;
    open_.push_back(add({.kind = kind}));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  JsonValue root_;
  // Open arrays and objects, each the last element of the one before, so none of them moves.
  std::vector<JsonValue*> open_;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &elements[static_cast<std::size_t>(found - names.begin())];
}

std::optional<JsonValue> parse_json(std::string_view text, std::size_t& error) {
  rapidjson::MemoryStream stream(text.data(), text.size());
  rapidjson::Reader reader;
  Builder builder;
  // An iterative parser, so that deep nesting cannot overflow the stack.
  constexpr unsigned flags = rapidjson::kParseIterativeFlag | rapidjson::kParseValidateEncodingFlag |
                             rapidjson::kParseFullPrecisionFlag;
  if (reader.Parse<flags>(stream, builder)) return builder.take();
  error = reader.GetErrorOffset();
  return std::nullopt;
}

}  // namespace supple::viewer
