#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "gltf/gltf_file.hpp"

namespace supple {

void GltfValue::fail_here(const std::string& message) const {
  fail(*file_ + ": " + (place_.empty() ? "the JSON" : place_) + ": " + message);
}

const nlohmann::json& GltfValue::required(const char* kind) const {
  if (value_ == nullptr) fail_here(std::string("is missing; expected ") + kind);
  return *value_;
}

GltfValue GltfValue::operator[](const char* key) const {
  const std::string place = place_.empty() ? key : place_ + "." + key;
  if (value_ == nullptr) return {nullptr, *file_, place};
  if (!value_->is_object()) fail_here("expected an object");
  const auto member = value_->find(key);
  return {member == value_->end() ? nullptr : &*member, *file_, place};
}

GltfValue GltfValue::at(std::uint64_t index) const {
  const std::string place = place_ + "[" + std::to_string(index) + "]";
  if (index >= size())
    fail_here("has no element " + std::to_string(index) + "; it has " + std::to_string(size()) +
              ", counted from 0");
  return {&(*value_)[index], *file_, place};
}

std::uint64_t GltfValue::size() const {
  if (value_ == nullptr) return 0;
  if (!value_->is_array()) fail_here("expected an array");
  return value_->size();
}

std::vector<std::string> GltfValue::keys() const {
  std::vector<std::string> result;
  if (value_ == nullptr) return result;
  if (!value_->is_object()) fail_here("expected an object");
  for (const auto& member : value_->items()) result.push_back(member.key());
  return result;
}

std::uint64_t GltfValue::whole() const {
  constexpr double most = 9007199254740992;  // 2^53
  const nlohmann::json& value = required("a whole number");
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  // Some exporters write 3.0.
  const double given = value.is_number() ? value.get<double>() : -1;
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
  const nlohmann::json& value = required("a number");
  if (!value.is_number()) fail_here("expected a number");
  return value.get<double>();
}

bool GltfValue::boolean_or(bool absent) const {
  if (value_ == nullptr) return absent;
  if (!value_->is_boolean()) fail_here("expected true or false");
  return value_->get<bool>();
}

std::string GltfValue::text() const {
  const nlohmann::json& value = required("a text");
  if (!value.is_string()) fail_here("expected a text");
  return value.get<std::string>();
}

std::vector<double> GltfValue::numbers(std::uint64_t count) const {
  if (size() != count) fail_here("expected " + std::to_string(count) + " numbers");
  std::vector<double> result;
  for (std::uint64_t i = 0; i < count; ++i) result.push_back(at(i).number());
  return result;
}

}  // namespace supple
