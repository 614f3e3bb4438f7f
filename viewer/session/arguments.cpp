#include "arguments.hpp"

#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace supple::viewer {
namespace {

constexpr std::int64_t largest_id = std::numeric_limits<std::uint32_t>::max();

/// The value as it was written, cut when it is long.
std::string text_of(const rapidjson::Value& value) {
  constexpr std::size_t longest = 40;
  if (value.IsArray()) return "a list";
  if (value.IsObject()) return "an object";
  rapidjson::StringBuffer buffer;
  rapidjson::Writer<rapidjson::StringBuffer> writer(buffer);
  value.Accept(writer);
  std::string text = buffer.GetString();
  if (text.size() > longest) text = text.substr(0, longest) + "…";
  return text;
}

std::string number_text(double value) {
  rapidjson::StringBuffer buffer;
  rapidjson::Writer<rapidjson::StringBuffer> writer(buffer);
  writer.Double(value);
  std::string text = buffer.GetString();
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

bool is_id(const rapidjson::Value& value) {
  return value.IsUint();
}

}  // namespace

std::optional<bool> Arguments::boolean(const char* name) {
  const rapidjson::Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->IsBool()) return value->GetBool();
  must_be(name, "true or false");
  return std::nullopt;
}

std::optional<std::int64_t> Arguments::integer(const char* name, std::int64_t low, std::int64_t high) {
  const rapidjson::Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->IsInt64() && value->GetInt64() >= low && value->GetInt64() <= high) return value->GetInt64();
  must_be(name, high < largest_id
                    ? "a whole number from " + std::to_string(low) + " to " + std::to_string(high)
                    : "a whole number, at least " + std::to_string(low));
  return std::nullopt;
}

std::optional<double> Arguments::number(const char* name, double low, double high) {
  const rapidjson::Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->IsNumber() && value->GetDouble() >= low && value->GetDouble() <= high) return value->GetDouble();
  must_be(name, "a number from " + number_text(low) + " to " + number_text(high));
  return std::nullopt;
}

std::optional<Vec3d> Arguments::point(const char* name) {
  const rapidjson::Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  const auto is_number = [](const rapidjson::Value& v) { return v.IsNumber(); };
  if (value->IsArray() && value->Size() == 3 && std::all_of(value->Begin(), value->End(), is_number))
    return Vec3d{(*value)[0].GetDouble(), (*value)[1].GetDouble(), (*value)[2].GetDouble()};
  must_be(name, "three numbers");
  return std::nullopt;
}

std::optional<std::array<std::uint32_t, 2>> Arguments::pair(const char* name) {
  const rapidjson::Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->IsArray() && value->Size() == 2 && is_id((*value)[0]) && is_id((*value)[1]))
    return std::array{(*value)[0].GetUint(), (*value)[1].GetUint()};
  must_be(name, "the numbers of an object and one of its triangles");
  return std::nullopt;
}

std::optional<std::vector<std::uint32_t>> Arguments::numbers(const char* name) {
  const rapidjson::Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!value->IsArray() || !std::all_of(value->Begin(), value->End(), is_id)) {
    must_be(name, "a list of whole numbers");
    return std::nullopt;
  }
  std::vector<std::uint32_t> numbers;
  for (const rapidjson::Value& number : value->GetArray()) numbers.push_back(number.GetUint());
  return numbers;
}

void Arguments::must_be(const char* name, const std::string& what) {
  fail(std::string(name) + " is " + text_of(*find(name)) + "; it must be " + what);
}

void Arguments::fail(std::string error) {
  if (error_.empty()) error_ = command_ + ": " + std::move(error);
}

bool Arguments::check() {
  for (const auto& member : object_.GetObject()) {
    const std::string_view name(member.name.GetString(), member.name.GetStringLength());
    if (name == "do" || name == "id" || std::find(known_.begin(), known_.end(), name) != known_.end())
      continue;
    std::string list;
    for (const std::string_view known : known_) list += (list.empty() ? "" : ", ") + std::string(known);
    fail("it has no " + text_of(member.name) + "; " +
         (known_.empty() ? "it takes nothing more" : "it takes " + list));
  }
  return error_.empty();
}

const rapidjson::Value* Arguments::find(const char* name) {
  if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
  const auto member = object_.FindMember(name);
  return member == object_.MemberEnd() ? nullptr : &member->value;
}

}  // namespace supple::viewer
