#include "program_source.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <string>
#include <utility>

namespace supple::viewer {
namespace {

void read(const Scene& scene, ObjectId id, std::vector<Vec3d>& positions) {
  positions.resize(scene.vertex_count(id));
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] = scene.position(id, static_cast<std::uint32_t>(v));
}

ViewedObject object_of(const Scene& scene, ObjectId id) {
  ViewedObject object;
  object.options = scene.options(id);
  object.mesh.name = object.options.name;
  read(scene, id, object.mesh.positions);
  object.mesh.triangles.resize(scene.triangle_count(id));
  for (std::uint32_t t = 0; t < object.mesh.triangles.size(); ++t)
    object.mesh.triangles[t] = scene.triangle(id, t).value_or(Triangle{});
  object.id = id;
  object.mesh_version = scene.mesh_version(id);
  return object;
}

/// Whether the page would show something else.
bool is_same(const Scene& scene, ObjectId id, const ViewedObject& object) {
  const ObjectOptions &now = scene.options(id), &before = object.options;
  return object.id == id && object.mesh_version == scene.mesh_version(id) &&
         now.is_static == before.is_static && now.margin == before.margin &&
         now.self_collision == before.self_collision;
}

}  // namespace

SceneView view_of_program(const Scene& scene, std::shared_ptr<Program> program, std::string title) {
  SceneView show;
  show.title = std::move(title);
  show.program = std::move(program);
  show.simulation.scene = scene.options();
  show.simulation.time_step = std::max(show.program->time_step(), 0.0);
  for (const ObjectId id : scene.objects()) {
    show.objects.resize(id.index);
    show.objects.push_back(object_of(scene, id));
  }
  return show;
}

ProgramSource::ProgramSource(const SceneView& show)
    : show_(show), versions_(show.objects.size(), 1), state_(program().state()) {
  for (const ViewedObject& object : show.objects) {
    ids_.push_back(object.id.value_or(ObjectId{static_cast<std::uint32_t>(ids_.size()), ~0u}));
    positions_.push_back(object.mesh.positions);
  }
}

bool ProgramSource::advance() {
  const bool ran = state_.runs;
  state_ = program().state();
  if (is_open() && !state_.is_held) {
    leave();
    return ran != state_.runs;
  }
  step_ = program().enter();
  const bool is_new = is_open() && read_count_ != state_.step_count;
  if (is_new && !changed_view()) read_positions();
  return is_new || ran != state_.runs;
}

/// Why the program is paused.
void ProgramSource::add_to(JsonText& json, const Center& center) const {
  const std::optional<Break>& reason = state_.reason;
  json.key("break");
  if (!reason) return json.null();
  json.begin_object();
  json.member("event", reason->event);
  json.member("text", reason->text);
  json.key("objects");
  json.begin_array();
  for (const auto& object : reason->objects) {
    if (object) json.value(object->index);
  }
  json.end_array();
  json.key("point");
  if (reason->point)
    json.value(*reason->point - center.at);
  else
    json.null();
  json.end_object();
}

void ProgramSource::leave() {
  step_ = nullptr;
  program().leave();
}

std::optional<SceneView> ProgramSource::changed_view() const {
  if (!is_open()) return std::nullopt;
  const std::vector<ObjectId> objects = scene().objects();
  const auto shown = std::count_if(show_.objects.begin(), show_.objects.end(),
                                   [](const ViewedObject& object) { return object.id.has_value(); });
  const auto is_shown = [&](ObjectId id) {
    return id.index < show_.objects.size() && is_same(scene(), id, show_.objects[id.index]);
  };
  if (objects.size() == static_cast<std::size_t>(shown) &&
      std::all_of(objects.begin(), objects.end(), is_shown))
    return std::nullopt;
  return view_of_program(scene(), show_.program, show_.title);
}

/// Static objects are read, too, because they can move between two steps.
void ProgramSource::read_positions() {
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (!show_.objects[i].id) continue;
    read(scene(), ids_[i], scratch_);
    std::vector<Vec3d>& shown = positions_[i];
    // Compares bits, so that NaN equals itself.
    if (shown.empty() || std::memcmp(shown.data(), scratch_.data(), shown.size() * sizeof(Vec3d)) == 0)
      continue;
    shown.swap(scratch_);
    ++versions_[i];
  }
  read_count_ = state_.step_count;
  read_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace supple::viewer
