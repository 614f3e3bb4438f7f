#include "base/text.hpp"

#include <algorithm>
#include <string_view>

#include "supple/result_descriptions.hpp"

namespace supple::cli {
namespace {

/// The number of letters to insert, remove, replace or swap with the next one to turn one word into the
/// other.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> two_before, before, row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_before = std::exchange(before, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest_of(const std::string& mistyped, const std::vector<std::string>& words) {
  std::optional<std::string> nearest;
  std::size_t least = std::max<std::size_t>(2, mistyped.size() / 4) + 1;
  for (const std::string& word : words) {
    const std::size_t distance = edit_distance(mistyped, word);
    if (distance >= least || distance >= word.size()) continue;
    least = distance;
    nearest = word;
  }
  return nearest;
}

std::string name_of(const Scene& scene, ObjectId object) {
  return fmt::format("{} {}", object.index, one_line(scene.options(object).name));
}

std::string name_of(Feature feature) {
  if (feature.kind == FeatureKind::face) return "f";
  return fmt::format("{}{}", feature.kind == FeatureKind::vertex ? 'v' : 'e', feature.index);
}

std::string element_name(FeatureKind kind, const std::array<std::uint32_t, 2>& ids) {
  const std::string name = fmt::format("{} {}", word_of(kind), ids[0]);
  return kind == FeatureKind::edge ? fmt::format("{} {}", name, ids[1]) : name;
}

std::string kind_word(FeatureKind a, FeatureKind b) {
  constexpr std::string_view letters = "vef";
  return {letters[static_cast<std::size_t>(a)], letters[static_cast<std::size_t>(b)]};
}

std::string grouped(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

std::string counted(std::uint64_t number, const std::string& noun, const std::string& nouns) {
  return fmt::format("{} {}", grouped(number), number == 1 ? noun : nouns.empty() ? noun + "s" : nouns);
}

}  // namespace supple::cli
