#include "scene_file/scene_file.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/files.hpp"
#include "base/text.hpp"
#include "inputs/placement.hpp"
#include "options/option_needs.hpp"
#include "scene_file/scene_motion.hpp"
#include "scene_file/toml_reader.hpp"
#include "supple/comparison.hpp"
#include "supple/format_descriptions.hpp"
#include "supple/models.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

/// The methods of `method`: the options of each key, or the paper's program.
constexpr std::array words_of_method{"default", "2007"};

std::string read_toml(const fs::path& path) {
  std::string text = read_text(path, most_toml_bytes + 1);
  if (text.size() > most_toml_bytes)
    fail("{}: a scene file has at most {} MB; name large meshes by their files", path.string(),
         most_toml_bytes >> 20);
  return text;
}

toml::table parse_toml(const std::string& text, const fs::path& path) {
  check_toml_limits(text, path);
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    fail("{}:{}: not valid TOML: {}", path.string(), error.source().begin.line,
         one_line(std::string(error.description())));
  }
}

std::string available_models() {
  std::vector<std::string_view> names(model_names().begin(), model_names().end());
  names.insert(names.end(), {"icosphere", "torus", "box", "cloth"});
  return fmt::format("{}", fmt::join(names, ", "));
}

bool is_named_model(const std::string& name) {
  const auto names = model_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

TriangleMesh named(TriangleMesh mesh, const std::string& name) {
  mesh.name = name;
  return mesh;
}

/// Counts the triangles of a scene file against `SceneOverrides::most_triangles`.
class TriangleBudget {
 public:
  explicit TriangleBudget(std::uint64_t most) : most_(most) {}
  /// Throws when `count` more triangles in each of `copies` are too many.
  void check(TomlReader& reader, const char* key, std::uint64_t count, std::uint64_t copies = 1) const {
    if (count > (most_ - used_) / std::max<std::uint64_t>(copies, 1))
      reader.fail(key, "more than {} triangles in all objects; give fewer or smaller objects", most_);
  }
  void use(std::uint64_t count) { used_ += count; }

 private:
  std::uint64_t most_, used_ = 0;
};

/// Reads the models that have additional keys.
TriangleMesh read_parametrised_model(TomlReader& reader, const std::string& name,
                                     const TriangleBudget& budget) {
  std::uint32_t frequency = 8, rings = 24, sides = 12, resolution = 1, columns = 16, rows = 16;
  if (name == "icosphere") {
    reader.read("frequency", frequency, 1, 4096);
    budget.check(reader, "frequency", 20 * std::uint64_t{frequency} * frequency);
    return make_icosphere(frequency);
  }
  if (name == "torus") {
    double major_radius = 0.5, minor_radius = 0.2;
    reader.read("rings", rings, 3, 1 << 16);
    reader.read("sides", sides, 3, 1 << 12);
    reader.read("major_radius", major_radius, ValueRange::above(0));
    reader.read("minor_radius", minor_radius, ValueRange::above(0));
    budget.check(reader, "rings", 2 * std::uint64_t{rings} * sides);
    return make_torus(rings, sides, major_radius, minor_radius);
  }
  if (name == "box") {
    Vec3d size{1, 1, 1};
    reader.read("size", size);
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) reader.fail("size", "must be three numbers above 0");
    reader.read("resolution", resolution, 1, 4096);
    budget.check(reader, "resolution", 12 * std::uint64_t{resolution} * resolution);
    return make_box(size, resolution);
  }
  if (name == "cloth") {
    double width = 1, depth = 1;
    reader.read("columns", columns, 1, 1 << 14);
    reader.read("rows", rows, 1, 1 << 14);
    reader.read("width", width, ValueRange::above(0));
    reader.read("depth", depth, ValueRange::above(0));
    budget.check(reader, "columns", 2 * std::uint64_t{columns} * rows);
    return make_cloth(columns, rows, width, depth);
  }
  reader.fail("model", "there is no model '{}'; choose one of {}", name, available_models());
}

/// Meshes by file or model name, because a scene often uses the same mesh many times.
struct Shapes {
  std::map<std::string, MeshFile> meshes;  ///< without conversion
  std::map<std::string, TriangleMesh> models;
};

/// The mesh of an object, and its file when it has one.
struct Shape {
  TriangleMesh mesh;
  std::optional<fs::path> file{};
  std::vector<std::string> clips{};
};

/// `frames` has the files of an object that is moved by files; such an object needs no other mesh.
Shape read_shape(TomlReader& reader, const fs::path& folder, const FrameSequence* frames,
                 const CoordinateConversion& conversion, const TriangleBudget& budget, Shapes& shapes) {
  std::string mesh, model;
  reader.read("mesh", mesh);
  reader.read("model", model);
  const auto converted = [&](MeshFile file, const fs::path& path) -> Shape {
    for (const CoordinateConversion& part : {CoordinateConversion{conversion.up, LengthUnit::file},
                                             CoordinateConversion{UpAxis::file, conversion.unit}}) {
      if (is_given(part) && !can_convert(file.frame, part))
        reader.fail(part.up != UpAxis::file ? "up" : "unit",
                    "the mesh file does not state its own; use rotate_xyz_degrees and scale");
    }
    convert(file.mesh.positions, file.frame, conversion);
    return {std::move(file.mesh), path, std::move(file.clips)};
  };
  if (frames && mesh.empty() && model.empty()) {
    Shape first = converted(read_mesh(frames->files.front()), frames->files.front());
    first.clips.clear();
    return first;
  }
  if (is_given(conversion) && mesh.empty())
    reader.fail(conversion.up != UpAxis::file ? "up" : "unit", "has no effect without mesh = \"FILE\"");
  if (reader.has("mesh") == reader.has("model"))
    reader.fail(reader.has("mesh") ? "model" : "", "give either mesh = \"FILE\" or model = \"NAME\"");
  if (reader.has("model")) {
    if (!is_named_model(model)) return {named(read_parametrised_model(reader, model, budget), model)};
    const auto [found, is_new] = shapes.models.try_emplace(model);
    if (is_new) found->second = named(make_model(model), model);
    return {found->second};
  }
  const fs::path path = folder / mesh;
  if (!fs::exists(path))
    reader.fail("mesh", "there is no file {}; paths start at the scene file's folder", path.string());
  const auto [found, is_new] = shapes.meshes.try_emplace(path.string());
  if (is_new) found->second = read_mesh(path);
  return converted(found->second, path);
}

Placement read_placement(TomlReader& reader) {
  Placement placement;
  reader.read("scale", placement.scale);
  reader.read("rotate_xyz_degrees", placement.rotate_xyz_degrees);
  reader.read("translate", placement.translate);
  return placement;
}

ObjectOptions read_options(TomlReader& reader, const ObjectOctreeOptions& octree) {
  ObjectOptions options{.octree = octree};
  reader.read_options(options);
  return options;
}

/// The copies of an object on a grid.
struct Copies {
  std::array<std::uint32_t, 3> repeat{1, 1, 1};
  Vec3d spacing;
  bool random_rotation = false;

  std::uint64_t count() const { return std::uint64_t{repeat[0]} * repeat[1] * repeat[2]; }
  /// The offset of a copy from the middle of the grid. Copies are counted along x first, then y, then z.
  Vec3d offset(std::uint64_t copy) const;
};

Vec3d Copies::offset(std::uint64_t copy) const {
  Vec3d offset;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t along = repeat[static_cast<std::size_t>(axis)];
    offset[axis] = (static_cast<double>(copy % along) - 0.5 * (along - 1.0)) * spacing[axis];
    copy /= along;
  }
  return offset;
}

Copies read_copies(TomlReader& reader) {
  constexpr std::uint32_t most_copies = 1'000'000;
  Copies copies;
  reader.read("repeat", copies.repeat, 1, most_copies);
  reader.read("spacing", copies.spacing);
  reader.read("random_rotation", copies.random_rotation);
  if (reader.has("spacing") && !reader.has("repeat"))
    reader.fail("spacing", "has no effect without repeat = [nx, ny, nz]");
  if (copies.count() > most_copies)
    reader.fail("repeat", "these are {} copies; at most {} are allowed", copies.count(), most_copies);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (copies.repeat[axis] > 1 && copies.spacing[static_cast<int>(axis)] == 0)
      reader.fail("repeat", "needs spacing = [dx, dy, dz] along each axis with more than one copy");
  }
  return copies;
}

/// What `[scene]` decides for all objects.
struct ObjectDefaults {
  Vec3d gravity;  ///< of masses and springs
  ObjectOctreeOptions octree;
};

void read_objects(const toml::table& table, const fs::path& path, const std::string& where,
                  const ObjectDefaults& defaults, TriangleBudget& budget, Shapes& shapes, Input& input) {
  TomlReader reader(path, table, where);
  ObjectOptions options = read_options(reader, defaults.octree);
  if (input.simulation.response)
    options.margin = std::max(options.margin, least_margin(*input.simulation.response));
  const Placement placement = read_placement(reader);
  const Copies copies = read_copies(reader);
  CoordinateConversion conversion;
  reader.read_options(conversion);
  SceneMotion motion(reader, path, where, defaults.gravity, conversion);
  if (!motion.empty() && options.is_static)
    reader.fail("motion", "a static object does not move; leave out motion or static");
  bool parts = false;
  reader.read("parts", parts);
  const Shape shape = read_shape(reader, path.parent_path(), motion.frames(), conversion, budget, shapes);
  const TriangleMesh& mesh = shape.mesh;
  reader.finish();
  if (shape.file) {
    if (const std::string note = note_of_reader(*shape.file); !note.empty()) input.notes.push_back(note);
  }
  motion.read_files(shape.file ? &*shape.file : nullptr, input.simulation.time_step, input.notes);
  if (motion.empty() && !shape.clips.empty())
    input.notes.push_back(clips_note(*shape.file, shape.clips, "motion = { kind = \"clip\" } plays one"));
  budget.check(reader, "repeat", mesh.triangles.size(), copies.count());
  budget.use(mesh.triangles.size() * copies.count());

  for (std::uint64_t copy = 0; copy < copies.count(); ++copy) {
    Placement placed = placement;
    if (copies.count() > 1) placed.translate = placed.translate + copies.offset(copy);
    if (copies.random_rotation) placed.turn = random_rotation(input.simulation.seed, input.objects.size());
    InputObject& object = input.objects.emplace_back(InputObject{mesh, options, {}, false, {}});
    place(object.mesh.positions, placed);
    if (placed.mirrors()) turn_over(object.mesh.triangles);
    object.motion = motion.of_copy(copy, placed, object.mesh.positions);
    if (!options.name.empty()) object.mesh.name = options.name;
    if (copies.count() > 1) object.mesh.name += fmt::format(" {}", copy + 1);
    object.options.name = object.mesh.name;
    object.splits = parts;
  }
  motion.check_boxes();
}

ContactResponse read_response(const toml::table& table, const fs::path& path) {
  TomlReader reader(path, table, "[scene]: response");
  ContactResponse response;
  for_each_field<ContactResponse>([&](const auto& field) { reader.read(field, response.*field.member); });
  reader.finish();
  return response;
}

void read_root(TomlReader& reader, const char* key, const std::optional<Border>& border,
               std::optional<RootCube>& root) {
  if (reader.read_cube(key, "border", root)) return;
  if (!border) reader.fail(key, "the scene has no border; add bounds = [[x, y, z], [x, y, z]]");
  root = cube_around((*border)[0], (*border)[1]);
}

/// Reads the options of the detection.
void read_detection(TomlReader& reader, const std::optional<Border>& border, SceneOptions& scene) {
  for_each_leaf(
      [&](const auto& field, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::optional<RootCube>>)
          read_root(reader, field.key, border, value);
        else if (!field.is_of_machine)
          reader.read(field, value);
      },
      scene);
  for (const OptionNeed& need : option_needs()) {
    if (reader.has(need.key) && !need.is_met(scene))
      reader.fail(need.key, "has no effect without {} = {}", need.decider, need.values);
  }
}

ObjectDefaults read_scene(const toml::table& table, const fs::path& path, SimulationOptions& simulation) {
  TomlReader reader(path, table, "[scene]");
  ObjectDefaults defaults;
  if (reader.has("bounds")) reader.read_box("bounds", simulation.border.emplace(), false);
  const bool as_2007 = reader.read_word("method", words_of_method) == std::size_t{1};
  if (as_2007) {
    defaults.octree = octree_of_2007();
    simulation.scene = with_method_of_2007(simulation.scene);
    const std::optional<Border>& border = simulation.border;
    if (border) simulation.scene.scene_octree.root = cube_around((*border)[0], (*border)[1]);
    simulation.fused_refit = true;
  }
  for_each_field<SimulationOptions>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(simulation.*field.member)>;
    if constexpr (!Described<Value> && !std::is_same_v<Value, std::optional<ContactResponse>>)
      reader.read(field, simulation.*field.member);
  });
  read_detection(reader, simulation.border, simulation.scene);
  if (as_2007 && !is_at_rest(simulation.scene))
    reader.fail("method", "2007 finds intersections; add them to contacts, or leave out method");
  if (!simulation.scene.comparison.lazy_refit && std::exchange(simulation.fused_refit, false) &&
      reader.has("fused_refit"))
    reader.fail("fused_refit", "has no effect without lazy_refit = \"on\"");
  reader.read("gravity", defaults.gravity);
  if (const toml::table* response = reader.table("response"))
    simulation.response = read_response(*response, path);
  reader.finish();
  return defaults;
}

}  // namespace

Input read_scene_file(const fs::path& path, const SceneOverrides& overrides) {
  return read_scene_text(read_toml(path), path, overrides);
}

SimulationOptions read_scene_options(const fs::path& path) {
  const toml::table file = parse_toml(read_toml(path), path);
  SimulationOptions simulation{.scene = default_scene_options()};
  TomlReader reader(path, file, "scene file");
  if (const toml::table* scene = reader.table("scene")) read_scene(*scene, path, simulation);
  return simulation;
}

Input read_scene_text(std::string text, const fs::path& path, const SceneOverrides& overrides) {
  Input input;
  input.scene_text = std::move(text);
  const toml::table file = parse_toml(input.scene_text, path);
  TomlReader reader(path, file, "scene file");
  ObjectDefaults defaults;
  input.simulation.scene = default_scene_options();
  if (const toml::table* scene = reader.table("scene")) defaults = read_scene(*scene, path, input.simulation);
  const std::vector<const toml::table*> objects = reader.tables("object", "[[object]]");
  reader.finish();
  input.simulation.seed = overrides.seed.value_or(input.simulation.seed);
  input.simulation.time_step = overrides.time_step.value_or(input.simulation.time_step);
  Shapes shapes;
  TriangleBudget budget(overrides.most_triangles);
  for (std::size_t i = 0; i < objects.size(); ++i)
    read_objects(*objects[i], path, fmt::format("[[object]] {}", i), defaults, budget, shapes, input);
  input.files.push_back(path);
  for (const auto& [name, shape] : shapes.meshes) input.files.emplace_back(name);
  for (const InputObject& object : input.objects) {
    if (const auto* frames = motion_of<FrameSequence>(object))
      input.files.insert(input.files.end(), frames->files.begin(), frames->files.end());
  }
  if (input.objects.empty()) fail("{}: has no objects; add an [[object]] with mesh or model", path.string());
  return input;
}

}  // namespace supple::cli
