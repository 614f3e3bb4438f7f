#include "inputs/inputs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/text.hpp"
#include "supple/scene.hpp"
#include "supple/topology.hpp"

namespace supple::cli {
namespace {

/// The numbers that vertices of the whole mesh have in a part; those of other parts are left out.
std::vector<std::uint32_t> ids_in_part(const std::vector<std::uint32_t>& of_mesh,
                                       const std::vector<std::uint32_t>& part) {
  std::vector<std::uint32_t> ids;
  for (const std::uint32_t vertex : of_mesh) {
    const auto place = std::lower_bound(part.begin(), part.end(), vertex);
    if (place != part.end() && *place == vertex)
      ids.push_back(static_cast<std::uint32_t>(place - part.begin()));
  }
  return ids;
}

/// The frames of a whole mesh, for its parts, which read one frame after the other.
class WholeFrames {
 public:
  explicit WholeFrames(const InputObject& whole)
      : motion_(*frames_of(whole)), positions_(whole.mesh.positions.size()) {}
  std::uint64_t count() const { return motion_.count; }
  void read(std::uint64_t frame, std::span<const std::uint32_t> vertices, std::span<Vec3d> positions) {
    const std::lock_guard lock(mutex_);
    if (frame_ != frame) {
      frame_.reset();
      motion_.positions(frame, positions_);
      frame_ = frame;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) positions[i] = positions_[vertices[i]];
  }

 private:
  ComputedMotion motion_;
  std::mutex mutex_;
  std::optional<std::uint64_t> frame_;  // of the positions
  std::vector<Vec3d> positions_;
};

/// The motion of a part: random motions differ from part to part, as those of copies do.
Motion motion_of_part(const InputObject& whole, const std::shared_ptr<WholeFrames>& frames,
                      std::uint64_t number, const std::vector<std::uint32_t>& vertices) {
  if (frames != nullptr) {
    return ComputedMotion{frames->count(),
                          [frames, vertices](std::uint64_t frame, std::span<Vec3d> positions) {
                            frames->read(frame, vertices, positions);
                          }};
  }
  Motion motion = *whole.motion;
  if (auto* const wave = std::get_if<WaveMotion>(&motion)) {
    wave->seed += number;
  } else if (auto* const rigid = std::get_if<RigidMotion>(&motion)) {
    if (rigid->seed) *rigid->seed += number;
  } else if (auto* const springs = std::get_if<MassSpringMotion>(&motion)) {
    if (springs->seed) *springs->seed += number;
    springs->springs.fixed_vertices = ids_in_part(springs->springs.fixed_vertices, vertices);
    for (MassSpringMotion::Handle& handle : springs->handles)
      handle.vertices = ids_in_part(handle.vertices, vertices);
    std::erase_if(springs->handles,
                  [](const MassSpringMotion::Handle& handle) { return handle.vertices.empty(); });
  } else {
    fail("{}: the frames of a recording have no parts; leave out the parts, or record again with parts",
         one_line(whole.mesh.name));
  }
  return motion;
}

void add_parts(InputObject whole, std::vector<InputObject>& objects) {
  std::vector<MeshPart> parts = split_into_parts(whole.mesh, whole.options.weld);
  std::shared_ptr<WholeFrames> frames;
  if (motion_of<FrameSequence>(whole) || motion_of<ComputedMotion>(whole))
    frames = std::make_shared<WholeFrames>(whole);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    MeshPart& part = parts[i];
    InputObject& object = objects.emplace_back();
    object.options = whole.options;
    if (whole.motion) object.motion = motion_of_part(whole, frames, i, part.vertices);
    object.mesh = std::move(part.mesh);
    if (parts.size() > 1) object.mesh.name += fmt::format(" part {}", i + 1);
    if (!object.options.name.empty()) object.options.name = object.mesh.name;
    object.part = PartOfMesh{whole.mesh.name, std::move(part.vertices), std::move(part.triangles), {}};
    if (!whole.options.solid) continue;
    object.part->not_solid = object.mesh.triangles.empty()
                                 ? "it has no triangles"
                                 : fault_of_solid(whole.options.weld ? welded(object.mesh) : object.mesh);
    object.options.solid = object.part->not_solid->empty();
  }
}

}  // namespace

/// What users should know about a solid whose connected parts intersect; empty when none do.
std::string note_of_parts(const InputObject& object) {
  const TriangleMesh mesh = object.options.weld ? welded(object.mesh) : object.mesh;
  if (!object.options.solid || compute_topology(mesh).components < 2 || !fault_of_solid(mesh).empty())
    return "";
  Scene scene;
  for (const MeshPart& part : split_into_parts(mesh)) scene.add(part.mesh);
  if (scene.detect({.max_contacts = 1}).contacts.empty()) return "";
  return fmt::format(
      "{}: connected parts of this solid intersect, so what is inside two of them is outside of the solid; "
      "--parts makes each part an object of its own",
      one_line(object.mesh.name));
}

void split_parts(Input& input) {
  std::vector<InputObject> objects;
  for (InputObject& object : input.objects) {
    if (object.splits)
      add_parts(std::move(object), objects);
    else if (std::string note = note_of_parts(objects.emplace_back(std::move(object))); !note.empty())
      input.notes.push_back(std::move(note));
  }
  input.objects = std::move(objects);
}

std::string describe_solid_parts(const Input& input) {
  constexpr std::size_t most_named = 20;
  std::size_t parts = 0, solid = 0;
  std::string solid_names, others;
  const auto name = [](std::string& names, std::size_t number, const std::string& text) {
    if (number <= most_named) names += text;
    if (number == most_named + 1) names += ", ...";
  };
  for (const InputObject& object : input.objects) {
    if (!object.part || !object.part->not_solid) continue;
    ++parts;
    const std::string text = one_line(object.mesh.name);
    if (object.options.solid)
      name(solid_names, ++solid, (solid_names.empty() ? ": " : ", ") + text);
    else
      name(others, parts - solid, fmt::format("\n  {}: {}", text, *object.part->not_solid));
  }
  if (parts == 0) return "";
  std::string text =
      fmt::format("{} of {} solid{}", grouped(solid), counted(parts, "part is", "parts are"), solid_names);
  if (!others.empty()) text += fmt::format("\nnot solid:{}", others);
  return text;
}

}  // namespace supple::cli
