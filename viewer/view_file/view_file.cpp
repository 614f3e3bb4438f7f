#include "view_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

#include "export/page_file.hpp"
#include "session/messages/json_value.hpp"
#include "supple/error.hpp"
#include "view_members.hpp"

namespace supple::viewer {
namespace {

using Members = std::vector<const ViewMember*>;

/// The name at a depth of a path; empty below its end.
std::string_view name_at(std::string_view path, std::size_t depth) {
  for (; depth > 0; --depth) {
    const std::size_t dot = path.find('.');
    path = dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
  }
  return path.substr(0, path.find('.'));
}

bool is_one_of(std::string_view word, std::string_view words) {
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (words.substr(0, end) == word) return true;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return false;
}

bool is_colour(std::string_view text) {
  return text.size() == 7 && text.front() == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos;
}

bool is_list_of(const JsonValue& value, std::size_t count, bool (*is_item)(const JsonValue&)) {
  return value.kind == JsonValue::Kind::list && value.elements.size() == count &&
         std::all_of(value.elements.begin(), value.elements.end(), is_item);
}

bool is_whole(const JsonValue& value) {
  return value.is_number() && std::floor(value.number) == value.number;
}

bool is_valid(const JsonValue& value, const ViewMember& member) {
  using Kind = JsonValue::Kind;
  switch (member.kind) {
    case ViewValue::number:
      return value.is_number() && member.range.allows(value.number);
    case ViewValue::whole:
      return is_whole(value) && member.range.allows(value.number);
    case ViewValue::truth:
      return value.kind == Kind::boolean;
    case ViewValue::word:
      return value.kind == Kind::text && is_one_of(value.text, member.words);
    case ViewValue::colour:
      return value.kind == Kind::text && is_colour(value.text);
    case ViewValue::text:
      return value.kind == Kind::text;
    case ViewValue::key:
      return value.kind == Kind::null || value.kind == Kind::text;
    case ViewValue::interval:
      return value.kind == Kind::null ||
             (is_list_of(value, 2, [](const JsonValue& x) { return x.is_number(); }) &&
              value.elements[0].number < value.elements[1].number);
    case ViewValue::point:
      return is_list_of(value, 3, [](const JsonValue& x) { return x.is_number(); });
    case ViewValue::objects:
      return value.kind == Kind::null || is_list_of(value, 2, [](const JsonValue& x) { return x.is_id(); });
  }
  return false;
}

/// Checks a value of which the members are all that have its path so far. Returns the fault, or nothing.
std::string fault_of(const JsonValue& value, const Members& members, std::size_t depth,
                     const std::string& path) {
  const bool is_leaf = name_at(members.front()->path, depth).empty();
  if (is_leaf) {
    return is_valid(value, *members.front()) ? "" : path + " is not " + text_of(*members.front());
  }
  if (value.kind != JsonValue::Kind::object)
    return path.empty() ? "it has no members; a view file is an object { … }"
                        : path + " is not an object { … }";
  for (std::size_t i = 0; i < value.elements.size(); ++i) {
    const std::string inner = path.empty() ? value.names[i] : path + "." + value.names[i];
    Members candidates;
    std::copy_if(members.begin(), members.end(), std::back_inserter(candidates),
                 [&](const ViewMember* member) {
                   const std::string_view name = name_at(member->path, depth);
                   return name == "*" || name == value.names[i];
                 });
    if (candidates.empty()) return inner + " is unknown; docs/viewer.md lists the members";
    std::string fault = fault_of(value.elements[i], candidates, depth + 1, inner);
    if (!fault.empty()) return fault;
  }
  return "";
}

[[noreturn]] void fail_of(const std::string& name, const std::string& fault) {
  throw Error(name + ": " + fault);
}

}  // namespace

std::string text_of(const ViewMember& member) {
  switch (member.kind) {
    case ViewValue::number:
      return text_of(member.range, false);
    case ViewValue::whole: {
      const auto whole = [](double x) { return std::to_string(static_cast<std::int64_t>(x)); };
      const std::string lowest = whole(member.range.lowest), highest = whole(member.range.highest);
      return lowest == highest ? lowest : "a whole number from " + lowest + " to " + highest;
    }
    case ViewValue::truth:
      return "true or false";
    case ViewValue::word: {
      std::string list = member.words;
      for (std::size_t at = 0; (at = list.find(' ', at)) != std::string::npos; at += 2)
        list.replace(at, 1, ", ");
      return "one of " + list;
    }
    case ViewValue::colour:
      return "a colour such as #8ecae6";
    case ViewValue::text:
      return "a text";
    case ViewValue::key:
      return "null, or a text";
    case ViewValue::interval:
      return "null, or two numbers of which the second is larger";
    case ViewValue::point:
      return "three finite numbers";
    case ViewValue::objects:
      return "null, or two objects by their numbers from 0";
  }
  return "";
}

void check_view(std::string_view text, const std::string& name) {
  std::size_t place = 0;
  const std::optional<JsonValue> view = parse_json(text, place);
  if (!view) fail_of(name, "it is not JSON: the error is at byte " + std::to_string(place));
  Members members;
  for (const ViewMember& member : view_members) members.push_back(&member);
  const std::string fault = fault_of(*view, members, 0, "");
  if (!fault.empty()) fail_of(name, fault);
  if (view->find("version") == nullptr) fail_of(name, "version is missing; write \"version\": 1");
}

std::string read_view(const std::filesystem::path& path) {
  std::error_code fault;
  if (std::filesystem::is_directory(path, fault)) fail_of(path.string(), "it is a folder; give a view file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_of(path.string(), "cannot be read; give a view file, which the page saves by Save view");
  std::string text;
  constexpr std::size_t part = 65536;
  for (std::vector<char> bytes(part); file && text.size() <= largest_view;) {
    file.read(bytes.data(), part);
    text.append(bytes.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (text.size() > largest_view)
    fail_of(path.string(), "it is larger than any view file, which has at most 16 MB");
  check_view(text, path.string());
  return text;
}

std::string page_with_json(std::string_view page, std::string_view id, std::string_view json) {
  std::string whole(page);
  const std::size_t at = place_of_cargo(page);
  std::string element = "<script type=\"application/json\" id=\"";
  element += id;
  element += "\">";
  // In JSON this character is only in texts. Escaped, it cannot end the element.
  for (const char c : json) {
    if (c == '<')
      element += "\\u003c";
    else
      element += c;
  }
  element += "</script>\n";
  whole.insert(at, element);
  return whole;
}

std::string page_of_spectators(std::string_view page) {
  return page_with_json(page, "supple-spectator", "true");
}

}  // namespace supple::viewer
