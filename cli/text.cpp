#include "text.hpp"

#include <fmt/core.h>

namespace supple::cli {
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string name_of(const Scene& scene, ObjectId object) {
  return fmt::format("{} {}", object.index, scene.name(object));
}

std::string grouped(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

std::string counted(std::uint64_t number, const std::string& noun) {
  return counted(number, noun, noun + "s");
}

std::string counted(std::uint64_t number, const std::string& noun, const std::string& nouns) {
  return fmt::format("{} {}", grouped(number), number == 1 ? noun : nouns);
}

}  // namespace supple::cli
