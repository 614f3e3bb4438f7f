#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "gltf_file.hpp"
#include "mesh/quotes.hpp"

namespace supple {

void GltfValue::fail_here(const std::string& message) const {
  fail(*file_ + ": " + (place_.empty() ? "the JSON" : place_) + ": " + message);
}

const rapidjson::Value& GltfValue::required(const char* kind) const {
  if (value_ == nullptr) fail_here(std::string("is missing; expected ") + kind);
  return *value_;
}

GltfValue GltfValue::operator[](const char* key) const {
  const std::string place = place_.empty() ? key : place_ + "." + key;
  if (value_ == nullptr) return {nullptr, *file_, place};
  if (!value_->IsObject()) fail_here("expected an object");
  const auto member = value_->FindMember(key);
  return {member == value_->MemberEnd() ? nullptr : &member->value, *file_, place};
}

GltfValue GltfValue::at(std::uint64_t index) const {
  const std::string place = place_ + "[" + std::to_string(index) + "]";
  if (index >= size())
    fail_here("has no element " + std::to_string(index) + "; it has " + std::to_string(size()) +
              ", counted from 0");
  return {&(*value_)[static_cast<rapidjson::SizeType>(index)], *file_, place};
}

std::uint64_t GltfValue::size() const {
  if (value_ == nullptr) return 0;
  if (!value_->IsArray()) fail_here("expected an array");
  return value_->Size();
}

std::vector<std::string> GltfValue::keys() const {
  std::vector<std::string> result;
  if (value_ == nullptr) return result;
  if (!value_->IsObject()) fail_here("expected an object");
  for (const auto& member : value_->GetObject())
    result.emplace_back(member.name.GetString(), member.name.GetStringLength());
  return result;
}

std::uint64_t GltfValue::whole() const {
  constexpr double most = 9007199254740992;  // 2^53
  const rapidjson::Value& value = required("a whole number");
  if (value.IsUint64()) return value.GetUint64();
  // Some exporters write 3.0.
  const double given = value.IsNumber() ? value.GetDouble() : -1;
  if (!(given >= 0 && given <= most) || given != std::floor(given)) fail_here("expected a whole number");
  return static_cast<std::uint64_t>(given);
}

std::uint32_t GltfValue::index(std::uint64_t limit, const char* what) const {
  const std::uint64_t value = whole();
  if (value >= limit)
    fail_here("there is no " + std::string(what) + " " + std::to_string(value) + "; the file has " +
              std::to_string(limit) + ", counted from 0");
  return static_cast<std::uint32_t>(value);
}

double GltfValue::number() const {
  const rapidjson::Value& value = required("a number");
  if (!value.IsNumber()) fail_here("expected a number");
  return value.GetDouble();
}

bool GltfValue::boolean_or(bool absent) const {
  if (value_ == nullptr) return absent;
  if (!value_->IsBool()) fail_here("expected true or false");
  return value_->GetBool();
}

std::string GltfValue::text() const {
  const rapidjson::Value& value = required("a text");
  if (!value.IsString()) fail_here("expected a text");
  return {value.GetString(), value.GetStringLength()};
}

std::vector<double> GltfValue::numbers(std::uint64_t count) const {
  if (size() != count) fail_here("expected " + std::to_string(count) + " numbers");
  std::vector<double> result;
  for (std::uint64_t i = 0; i < count; ++i) result.push_back(at(i).number());
  return result;
}

}  // namespace supple
