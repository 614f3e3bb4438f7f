#include "inputs.hpp"

#include <fmt/core.h>
#include <glob.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "recorded_input.hpp"
#include "scene_file.hpp"
#include "supple/error.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Removes a run of digits, or of other characters, from the front.
std::string_view take_run(std::string_view& text) {
  std::size_t end = 1;
  while (end < text.size() && is_digit(text[end]) == is_digit(text[0])) ++end;
  const std::string_view run = text.substr(0, end);
  text.remove_prefix(end);
  return run;
}

std::string_view without_leading_zeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
}

int compare_numbers(std::string_view a, std::string_view b) {
  a = without_leading_zeros(a);
  b = without_leading_zeros(b);
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

std::vector<fs::path> files_that_match(const std::string& pattern) {
  glob_t found{};
  const int status = glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> names(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  if (status != 0 || names.empty())
    throw Error(one_line(
        fmt::format("{}: no file matches this pattern; check the folder and the spelling", pattern)));
  std::sort(names.begin(), names.end(), natural_less);
  return {names.begin(), names.end()};
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    const std::string_view run_a = take_run(rest_a), run_b = take_run(rest_b);
    const int order =
        is_digit(run_a[0]) && is_digit(run_b[0]) ? compare_numbers(run_a, run_b) : run_a.compare(run_b);
    if (order != 0) return order < 0;
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  return a < b;  // equal numbers, such as frame_1 and frame_01
}

std::vector<fs::path> expand_patterns(const std::vector<std::string>& names) {
  std::vector<fs::path> paths;
  for (const std::string& name : names) {
    if (name.find_first_of("*?[") == std::string::npos || fs::exists(name)) {
      paths.emplace_back(name);
      continue;
    }
    const std::vector<fs::path> matches = files_that_match(name);
    paths.insert(paths.end(), matches.begin(), matches.end());
  }
  return paths;
}

bool is_scene_file(const std::string& name) {
  std::string extension = fs::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".toml";
}

Input read_objects(const std::vector<std::string>& names, const SceneOverrides& overrides) {
  const auto scene = std::find_if(names.begin(), names.end(), is_scene_file);
  if (scene != names.end()) {
    if (names.size() > 1)
      throw Error(fmt::format(
          "{}: a scene file must be the only input; add the other meshes to it as objects", *scene));
    return read_scene_file(*scene, overrides);
  }
  if (const auto recording = std::find_if(names.begin(), names.end(), is_recording);
      recording != names.end()) {
    if (names.size() > 1)
      throw Error(
          fmt::format("{}: a recording must be the only input; leave out the other inputs", *recording));
    return read_recording(*recording);
  }
  Input input;
  input.files = expand_patterns(names);
  for (const fs::path& path : input.files) input.objects.push_back({read_mesh(path), {}, {}});
  return input;
}

Input read_sequence(const std::vector<std::string>& names) {
  const auto scene = std::find_if(names.begin(), names.end(), is_scene_file);
  if (scene != names.end())
    throw Error(
        fmt::format("{}: a scene file cannot be a frame of a sequence; leave out --sequence", *scene));
  if (const auto recording = std::find_if(names.begin(), names.end(), is_recording); recording != names.end())
    throw Error(fmt::format("{}: a recording has its own frames; leave out --sequence", *recording));
  FrameSequence frames;
  frames.files = expand_patterns(names);
  for (const fs::path& path : frames.files) {
    if (!fs::exists(path))
      throw Error(fmt::format("{}: there is no such file; check the folder and the spelling", path.string()));
  }
  Input input;
  input.files = frames.files;
  input.frames = {frames.files.front().string(), frames.files.size()};
  TriangleMesh first = read_mesh(frames.files.front());
  input.objects.push_back({std::move(first), {}, std::move(frames)});
  return input;
}

}  // namespace supple::cli
