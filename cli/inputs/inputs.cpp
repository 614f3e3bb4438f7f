#include "inputs/inputs.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/text.hpp"
#include "inputs/clips.hpp"
#include "scene_file/scene_file.hpp"
#include "supple/formats.hpp"

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
    fail("{}: no file matches this pattern; check the folder and the spelling", pattern);
  std::sort(names.begin(), names.end(), natural_less);
  return {names.begin(), names.end()};
}

/// The part of a file name with the number of a frame: its last digits before the extension. Empty when there
/// are none.
struct NumberedName {
  std::string_view before, digits, after;

  explicit NumberedName(std::string_view name) {
    const std::size_t stem = std::min(name.rfind('.'), name.size());
    std::size_t end = stem;
    while (end > 0 && !is_digit(name[end - 1])) --end;
    std::size_t begin = end;
    while (begin > 0 && is_digit(name[begin - 1])) --begin;
    before = name.substr(0, begin);
    digits = name.substr(begin, end - begin);
    after = name.substr(end);
  }
};

[[noreturn]] void refuse_folder(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::span<const std::string_view> known = supported_extensions();
    if (std::binary_search(known.begin(), known.end(), lower_case_extension(entry.path())))
      names.push_back(entry.path().filename().string());
  }
  if (names.empty()) fail("{}: is a folder without mesh files; give mesh files", folder.string());
  const std::string first = *std::min_element(names.begin(), names.end(), natural_less);
  const NumberedName name(first);
  const std::string pattern = name.digits.empty() ? '*' + fs::path(first).extension().string()
                                                  : fmt::format("{}*{}", name.before, name.after);
  fail("{}: is a folder; give its files as a quoted pattern: '{}'", folder.string(),
       (folder / pattern).string());
}

/// Refuses names such as frame_%04d.obj and frame_####.obj, which other programs replace by numbers.
void refuse_number_format(const std::string& name) {
  const std::size_t begin = name.find_first_of("%#");
  if (begin == std::string::npos || fs::exists(name)) return;
  std::size_t end = name.find_first_not_of(name[begin] == '#' ? "#" : "0123456789", begin + 1);
  end = std::min(end, name.size());
  if (name[begin] == '%') {
    if (end == name.size() || (name[end] != 'd' && name[end] != 'i' && name[end] != 'u')) return;
    ++end;
  }
  fail("{}: no file has this name; give numbered files as a quoted pattern: '{}*{}'", name,
       name.substr(0, begin), name.substr(end));
}

/// Throws when an option of `reading` has no effect on a scene file or a recording.
void check_no_reading(const std::string& name, const MeshReading& reading, const char* instead) {
  const char* option = reading.conversion.up != UpAxis::file         ? "--up"
                       : reading.conversion.unit != LengthUnit::file ? "--unit"
                       : reading.clips.clip                          ? "--clip"
                       : reading.clips.fps                           ? "--fps"
                       : !reading.cache.empty()                      ? "--cache"
                                                                     : nullptr;
  if (option != nullptr) fail("{}: {} applies to mesh files only; {}", name, option, instead);
}

/// Throws when the conversion applies to none of the files.
void check_conversion(const std::vector<CoordinateFrame>& frames, const CoordinateConversion& conversion) {
  const auto states = [&](const CoordinateConversion& part) {
    return std::any_of(frames.begin(), frames.end(),
                       [&](const CoordinateFrame& frame) { return can_convert(frame, part); });
  };
  if (conversion.up != UpAxis::file && !states({conversion.up, LengthUnit::file}))
    fail("--up: no file states which axis points up; a scene file can rotate meshes, rotate_xyz_degrees");
  if (conversion.unit != LengthUnit::file && !states({UpAxis::file, conversion.unit}))
    fail("--unit: no file states its unit; a scene file can scale meshes, scale");
}

/// Plays the clip of an object.
void add_clip(const fs::path& path, const MeshReading& reading, InputObject& object, Input& input) {
  const ClipPlayer player(path, reading.clips.clip);
  ComputedMotion motion = player.frames(reading.clips, reading.conversion);
  if (!input.frames || motion.count > input.frames->count) {
    input.frames = {path.string(), motion.count};
    const double seconds = player.clip().end - player.clip().start;
    if (reading.clips.fps || !reading.clips.frames)
      input.simulation.time_step = 1 / reading.clips.fps.value_or(film_rate);
    else if (motion.count > 1 && seconds > 0)
      input.simulation.time_step = seconds / static_cast<double>(motion.count - 1);
  }
  object.motion = std::move(motion);
  if (std::string note = player.note(reading.clips.clip, "--clip NAME"); !note.empty())
    input.notes.push_back(std::move(note));
}

Input read_meshes(const std::vector<std::string>& names, const MeshReading& reading) {
  Input input;
  input.files = expand_patterns(names);
  std::vector<CoordinateFrame> frames;
  for (const fs::path& path : input.files) {
    MeshFile file = read_mesh(path, reading.conversion);
    frames.push_back(file.frame);
    if (const std::string note = note_of_reader(path); !note.empty()) input.notes.push_back(note);
    InputObject& object = input.objects.emplace_back(InputObject{std::move(file.mesh), {}, {}});
    if (file.clips.empty()) continue;
    if (reading.clips.is_given())
      add_clip(path, reading, object, input);
    else
      input.notes.push_back(clips_note(path, file.clips, "--frames N plays one"));
  }
  if (is_given(reading.conversion)) check_conversion(frames, reading.conversion);
  if ((reading.clips.clip || reading.clips.fps) && !input.frames)
    fail("{}: no file has an animation that moves its mesh; leave it out",
         reading.clips.clip ? "--clip" : "--fps");
  if (!reading.cache.empty()) {
    if (input.objects.size() != 1 || input.frames)
      fail("--cache: needs one mesh without a clip; use a scene file for more objects");
    InputObject& object = input.objects.front();
    ComputedMotion motion = play_cache(reading.cache, object.mesh.positions.size(), false, {});
    input.frames = {reading.cache, motion.count};
    input.files.emplace_back(reading.cache);
    object.motion = std::move(motion);
  }
  return input;
}

}  // namespace

std::string Input::name(ObjectId object) const {
  const InputObject& found = objects[object.index];
  if (!found.options.name.empty()) return found.options.name;
  return found.mesh.name.empty() ? fmt::format("object {}", object.index) : found.mesh.name;
}

std::string name_of(const Input& input, ObjectId object) {
  return fmt::format("{} {}", object.index, one_line(input.name(object)));
}

std::string clips_note(const fs::path& path, const std::vector<std::string>& clips, const char* advice) {
  return one_line(fmt::format("{}: has {}: {}; {}", path.string(), counted(clips.size(), "clip"),
                              fmt::join(clips, ", "), advice));
}

std::string note_of_reader(const fs::path& path) {
  if (lower_case_extension(path) != ".fbx" || !is_read_by_assimp(path)) return {};
  return one_line(
      fmt::format("{}: read through Assimp, because this build is without ufbx: the pose of rotated, scaled, "
                  "deformed and animated nodes can be wrong; build with ufbx, or export it as glTF",
                  path.string()));
}

void print_notes(const Input& input) {
  for (const std::string& note : input.notes) fmt::print(stderr, "supple: note: {}\n", note);
}

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
      if (fs::is_directory(name)) refuse_folder(name);
      refuse_number_format(name);
      paths.emplace_back(name);
      continue;
    }
    const std::vector<fs::path> matches = files_that_match(name);
    paths.insert(paths.end(), matches.begin(), matches.end());
  }
  return paths;
}

std::string describe_gaps(const std::vector<fs::path>& files) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> steps;
  std::uint64_t least = ~std::uint64_t{0};
  for (std::size_t i = 1; i < files.size(); ++i) {
    const std::string from = files[i - 1].string(), to = files[i].string();
    const NumberedName a(from), b(to);
    constexpr std::size_t most_digits = 18;  // of numbers below 2^63
    if (a.before != b.before || a.after != b.after || a.digits.empty() || b.digits.empty() ||
        std::max(a.digits.size(), b.digits.size()) > most_digits)
      return {};
    const std::uint64_t start = std::stoull(std::string(a.digits)), end = std::stoull(std::string(b.digits));
    if (end <= start) return {};
    steps.emplace_back(start, end);
    least = std::min(least, end - start);
  }
  std::erase_if(steps, [&](const auto& step) { return step.second - step.first == least; });
  if (steps.empty()) return {};
  return fmt::format("note: the numbers of the frames have {}: frame {} follows frame {} directly{}",
                     counted(steps.size(), "gap"), steps[0].second, steps[0].first,
                     steps.size() > 1 ? ", and so on" : "");
}

bool is_scene_file(const std::string& name) {
  return lower_case_extension(name) == ".toml";
}

bool is_recording(const std::string& name) {
  const std::string extension = lower_case_extension(name);
  return extension == ".h5" || extension == ".hdf5";
}

Input read_recording(const std::string& name) {
  const auto recording = std::make_shared<const Recording>(name);
  if (recording->frame_count() == 0) fail("{}: the recording has no frame; record some steps", name);
  const RecordingHeader& header = recording->header();
  Input input;
  input.files = {name};
  input.frames = {name, recording->frame_count()};
  input.simulation.time_step = header.time_step;
  for (std::size_t i = 0; i < header.objects.size(); ++i) {
    const RecordedObject& object = header.objects[i];
    InputObject& added = input.objects.emplace_back();
    added.options = object.options;
    added.mesh = {object.options.name, recording->positions(0, i), object.triangles,
                  std::exchange(added.options.edges, {}), std::exchange(added.options.points, {})};
    if (!object.options.is_static) added.motion = RecordedMotion{recording, i};
  }
  return input;
}

Input read_objects(const std::vector<std::string>& names, const SceneOverrides& overrides,
                   const MeshReading& reading) {
  const auto scene = std::find_if(names.begin(), names.end(), is_scene_file);
  if (scene != names.end()) {
    if (names.size() > 1)
      fail("{}: a scene file must be the only input; add the other meshes to it as objects", *scene);
    check_no_reading(*scene, reading, "an [[object]] has keys for it");
    return read_scene_file(*scene, overrides);
  }
  if (const auto recording = std::find_if(names.begin(), names.end(), is_recording);
      recording != names.end()) {
    if (names.size() > 1)
      fail("{}: a recording must be the only input; leave out the other inputs", *recording);
    check_no_reading(*recording, reading, "leave it out");
    return read_recording(*recording);
  }
  return read_meshes(names, reading);
}

Input read_sequence(const std::vector<std::string>& names, const CoordinateConversion& conversion) {
  const auto scene = std::find_if(names.begin(), names.end(), is_scene_file);
  if (scene != names.end())
    fail("{}: a scene file cannot be a frame of a sequence; leave out --sequence", *scene);
  if (const auto recording = std::find_if(names.begin(), names.end(), is_recording); recording != names.end())
    fail("{}: a recording has its own frames; leave out --sequence", *recording);
  FrameSequence frames;
  frames.conversion = conversion;
  frames.files = expand_patterns(names);
  for (const fs::path& path : frames.files) {
    if (!fs::exists(path))
      fail("{}: there is no such file; check the folder and the spelling", path.string());
  }
  Input input;
  input.files = frames.files;
  input.frames = {frames.files.front().string(), frames.files.size()};
  MeshFile first = read_mesh(frames.files.front(), conversion);
  if (is_given(conversion)) check_conversion({first.frame}, conversion);
  input.objects.push_back({std::move(first.mesh), {}, std::move(frames)});
  return input;
}

std::optional<ComputedMotion> frames_of(const InputObject& object) {
  if (const auto* sequence = motion_of<FrameSequence>(object)) {
    const auto files = std::make_shared<const FrameFiles>(*sequence, object.mesh);
    return ComputedMotion{sequence->files.size(), [files](std::uint64_t frame, std::span<Vec3d> positions) {
                            files->read(frame, positions);
                          }};
  }
  if (const auto* recorded = motion_of<RecordedMotion>(object)) {
    return ComputedMotion{recorded->recording->frame_count(),
                          [motion = *recorded](std::uint64_t frame, std::span<Vec3d> positions) {
                            std::ranges::copy(motion.recording->positions(frame, motion.object),
                                              positions.begin());
                          }};
  }
  const auto* computed = motion_of<ComputedMotion>(object);
  return computed ? std::optional(*computed) : std::nullopt;
}

std::size_t count_finite_triangles(const TriangleMesh& mesh) {
  return static_cast<std::size_t>(std::ranges::count_if(mesh.triangles, [&](const Triangle& triangle) {
    return std::ranges::all_of(triangle, [&](std::uint32_t v) {
      const Vec3d& p = mesh.positions[v];
      return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    });
  }));
}

}  // namespace supple::cli
