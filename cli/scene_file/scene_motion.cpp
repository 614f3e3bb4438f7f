#include "scene_file/scene_motion.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "inputs/clips.hpp"
#include "supple/error.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::cli {
namespace {

bool holds(const Border& box, Vec3d p) {
  return p.x >= box[0].x && p.x <= box[1].x && p.y >= box[0].y && p.y <= box[1].y && p.z >= box[0].z &&
         p.z <= box[1].z;
}

std::vector<std::uint32_t> vertices_in(const Border& box, const std::vector<Vec3d>& positions) {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (holds(box, positions[i])) vertices.push_back(i);
  }
  return vertices;
}

bool contains(const std::vector<std::uint32_t>& ascending, std::uint32_t vertex) {
  return std::binary_search(ascending.begin(), ascending.end(), vertex);
}

}  // namespace

SceneMotion::SceneMotion(TomlReader& object, const std::filesystem::path& scene_file, std::string where,
                         Vec3d gravity, const CoordinateConversion& conversion)
    : file_(scene_file),
      conversion_(conversion),
      table_(object.table("motion")),
      where_(std::move(where) + ": motion") {
  if (!table_) return;
  TomlReader reader(file_, *table_, where_);
  read_kind(reader, gravity);
  reader.finish();
  fixed_found_.resize(fixed_.size());
  pulls_found_.resize(pulls_.size());
}

void SceneMotion::read_kind(TomlReader& reader, Vec3d gravity) {
  std::string kind;
  reader.read("kind", kind);
  if (kind == "wave" || kind == "sway")  // "sway" is the old name
    reader.read_options(motion_.emplace().emplace<WaveMotion>());
  else if (kind == "mass_spring")
    motion_ = read_mass_spring(reader, gravity);
  else if (kind == "rigid")
    reader.read_options(motion_.emplace().emplace<RigidMotion>());
  else if (kind == "frames")
    motion_ = read_frames(reader);
  else if (kind == "clip" || kind == "cache")
    read_playback(reader, kind == "cache");
  else if (kind.empty())
    reader.fail(
        "kind",
        "kind is missing; choose kind = \"wave\", \"mass_spring\", \"rigid\", \"frames\", \"clip\" or "
        "\"cache\"");
  else
    reader.fail("kind", "'{}' is not one of wave, mass_spring, rigid, frames, clip, cache", kind);
}

void SceneMotion::read_playback(TomlReader& reader, bool is_cache) {
  Playback& playback = playback_.emplace(Playback{.clip = {}, .cache = {}, .speed = 1, .loop = false});
  reader.read("loop", playback.loop);
  if (is_cache) {
    std::string file;
    reader.read("file", file);
    if (file.empty()) reader.fail("file", "file is missing; give the point cache, file = \"body.pc2\"");
    playback.cache = file_.parent_path() / file;
    return;
  }
  if (reader.has("clip")) reader.read("clip", playback.clip.emplace());
  reader.read("speed", playback.speed, ValueRange::above(0));
}

void SceneMotion::read_files(const std::filesystem::path* mesh_file, double time_step,
                             std::vector<std::string>& notes) {
  if (!playback_) return;
  const TomlReader reader(file_, *table_, where_);
  const Playback playback = *playback_;
  if (mesh_file == nullptr)
    reader.fail("kind", "needs mesh = \"FILE\": a built-in model has no clips and no cache");
  try {
    if (!playback.cache.empty()) {
      play_ = [playback](const Placement& placement, std::size_t vertices) {
        return play_cache(playback.cache, vertices, playback.loop, placement);
      };
      return;
    }
    const ClipPlayer player(*mesh_file, playback.clip);
    if (std::string note = player.note(playback.clip, "motion = { kind = \"clip\", clip = \"NAME\" }");
        !note.empty())
      notes.push_back(std::move(note));
    play_ = [=, conversion = conversion_](const Placement& placement, std::size_t) {
      return player.steps(time_step, playback.speed, playback.loop, conversion, placement);
    };
  } catch (const Error& error) {
    reader.fail("kind", "{}", error.what());
  }
}

MassSpringMotion SceneMotion::read_mass_spring(TomlReader& reader, Vec3d gravity) {
  MassSpringMotion motion;
  motion.springs.gravity = gravity;
  reader.read_options(motion);
  reader.read("fixed", fixed_);
  read_pulls(reader);
  return motion;
}

void SceneMotion::read_pulls(TomlReader& reader) {
  for (const toml::table* table :
       reader.tables("pull", "pull = [{ box = …, by = …, seconds = … }], a table")) {
    TomlReader pull(file_, *table, fmt::format("{}: pull {}", where_, pulls_.size()));
    Pull& added = pulls_.emplace_back();
    pull.read_box("box", added.box, true);
    pull.read("by", added.by);
    pull.read("seconds", added.seconds, ValueRange::above(0));
    for (const char* key : {"box", "by"}) {
      if (!pull.has(key)) pull.fail(key, "{} is missing; a pull is {{ box, by, seconds }}", key);
    }
    pull.finish();
  }
}

FrameSequence SceneMotion::read_frames(TomlReader& reader) const {
  FrameSequence frames;
  frames.conversion = conversion_;
  std::string pattern;
  reader.read("files", pattern);
  reader.read("loop", frames.loop);
  if (pattern.empty()) reader.fail("files", "files is missing; give the frames, files = \"frame_*.ply\"");
  try {
    frames.files = expand_patterns({(file_.parent_path() / pattern).string()});
  } catch (const Error& error) {
    reader.fail("files", "{}", error.what());
  }
  if (!std::filesystem::exists(frames.files.front()))
    reader.fail("files", "there is no file {}; paths start at the scene file's folder",
                frames.files.front().string());
  return frames;
}

std::optional<Motion> SceneMotion::of_copy(std::uint64_t copy, const Placement& placement,
                                           const std::vector<Vec3d>& positions) {
  if (play_) return play_(placement, positions.size());
  if (!motion_) return std::nullopt;
  Motion motion = *motion_;
  if (auto* waves = std::get_if<WaveMotion>(&motion)) waves->seed += copy;
  if (auto* rigid = std::get_if<RigidMotion>(&motion); rigid && rigid->seed) *rigid->seed += copy;
  if (auto* frames = std::get_if<FrameSequence>(&motion)) frames->placement = placement;
  if (auto* springs = std::get_if<MassSpringMotion>(&motion)) {
    if (springs->seed) *springs->seed += copy;
    select_vertices(*springs, positions);
  }
  return motion;
}

void SceneMotion::select_vertices(MassSpringMotion& motion, const std::vector<Vec3d>& positions) {
  std::vector<std::uint32_t>& fixed = motion.springs.fixed_vertices;
  for (std::size_t i = 0; i < fixed_.size(); ++i) {
    const std::vector<std::uint32_t> found = vertices_in(fixed_[i], positions);
    fixed_found_[i] = fixed_found_[i] || !found.empty();
    fixed.insert(fixed.end(), found.begin(), found.end());
  }
  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());

  std::vector<std::uint32_t> taken = fixed;
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    const std::vector<std::uint32_t> found = vertices_in(pulls_[i].box, positions);
    const auto twice = std::find_if(found.begin(), found.end(),
                                    [&](std::uint32_t vertex) { return contains(taken, vertex); });
    if (twice != found.end())
      TomlReader(file_, *table_, where_)
          .fail("pull",
                "box {} holds vertex {}, which is fixed or pulled by another box; the "
                "boxes must not share vertices",
                i, *twice);
    if (found.empty()) continue;
    pulls_found_[i] = true;
    motion.handles.push_back({found, pulls_[i].by, pulls_[i].seconds});
    taken.insert(taken.end(), found.begin(), found.end());
    std::sort(taken.begin(), taken.end());
  }
}

void SceneMotion::check_boxes() const {
  const auto check = [&](const char* key, const std::vector<bool>& found) {
    const auto empty = std::find(found.begin(), found.end(), false);
    if (empty != found.end())
      TomlReader(file_, *table_, where_)
          .fail(key,
                "box {} holds no vertex; boxes are in the coordinates of the placed mesh, "
                "which supple info shows",
                empty - found.begin());
  };
  check("fixed", fixed_found_);
  check("pull", pulls_found_);
}

}  // namespace supple::cli
