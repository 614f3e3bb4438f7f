#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace supple {

inline std::string_view without_prefix(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// The name without the prefix of a namespace, which files choose themselves.
inline std::string_view name_of(const pugi::xml_node& node) {
  return without_prefix(node.name());
}

/// The attribute with this name after its prefix.
inline std::string attribute(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_attribute& candidate : node.attributes()) {
    if (without_prefix(candidate.name()) == name) return candidate.value();
  }
  return {};
}

inline pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node& candidate : node.children()) {
    if (name_of(candidate) == name) return candidate;
  }
  return {};
}

}  // namespace supple
