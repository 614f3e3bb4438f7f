#include "scene_file.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "placement.hpp"
#include "supple/error.hpp"
#include "supple/formats.hpp"
#include "supple/models.hpp"
#include "text.hpp"
#include "toml_reader.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();

toml::table parse_toml(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || fs::is_directory(path))
    throw Error(
        fmt::format("{}: cannot read this scene file; check the folder and the spelling", path.string()));
  try {
    return toml::parse(stream, path.string());
  } catch (const toml::parse_error& error) {
    throw Error(fmt::format("{}:{}: not valid TOML: {}", path.string(), error.source().begin.line,
                            one_line(std::string(error.description()))));
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

/// These take keys of their own.
TriangleMesh read_parametrised_model(TomlReader& reader, const std::string& name) {
  std::uint32_t frequency = 8, rings = 24, sides = 12, resolution = 1, columns = 16, rows = 16;
  if (name == "icosphere") {
    reader.read("frequency", frequency, 1, 4096);
    return make_icosphere(frequency);
  }
  if (name == "torus") {
    double major_radius = 0.5, minor_radius = 0.2;
    reader.read("rings", rings, 3, 1 << 16);
    reader.read("sides", sides, 3, 1 << 12);
    reader.read_positive("major_radius", major_radius);
    reader.read_positive("minor_radius", minor_radius);
    return make_torus(rings, sides, major_radius, minor_radius);
  }
  if (name == "box") {
    Vec3d size{1, 1, 1};
    reader.read("size", size);
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) reader.fail("size", "must be three numbers above 0");
    reader.read("resolution", resolution, 1, 4096);
    return make_box(size, resolution);
  }
  if (name == "cloth") {
    double width = 1, depth = 1;
    reader.read("columns", columns, 1, 1 << 14);
    reader.read("rows", rows, 1, 1 << 14);
    reader.read_positive("width", width);
    reader.read_positive("depth", depth);
    return make_cloth(columns, rows, width, depth);
  }
  reader.fail("model", fmt::format("there is no model '{}'; choose one of {}", name, available_models()));
}

/// Meshes by file or model name: a scene often has the same one many times.
using Shapes = std::map<std::string, TriangleMesh>;

TriangleMesh read_shape(TomlReader& reader, const fs::path& folder, Shapes& shapes) {
  std::string mesh, model;
  reader.read("mesh", mesh);
  reader.read("model", model);
  if (reader.has("mesh") == reader.has("model"))
    reader.fail(reader.has("mesh") ? "model" : "", "give either mesh = \"FILE\" or model = \"NAME\"");
  if (reader.has("model")) {
    if (!is_named_model(model)) return named(read_parametrised_model(reader, model), model);
    const auto [found, is_new] = shapes.try_emplace("model " + model);
    if (is_new) found->second = named(make_model(model), model);
    return found->second;
  }
  const fs::path path = folder / mesh;
  if (!fs::exists(path))
    reader.fail("mesh",
                fmt::format("there is no file {}; paths start at the scene file's folder", path.string()));
  const auto [found, is_new] = shapes.try_emplace("mesh " + path.string());
  if (is_new) found->second = load_any_mesh(path);
  return found->second;
}

Placement read_placement(TomlReader& reader) {
  Placement placement;
  reader.read("scale", placement.scale);
  reader.read("rotate_xyz_degrees", placement.rotate_xyz_degrees);
  reader.read("translate", placement.translate);
  return placement;
}

ObjectOptions read_options(TomlReader& reader) {
  ObjectOptions options;
  reader.read("name", options.name);
  reader.read("self", options.self_collision);
  reader.read("static", options.is_static);
  reader.read("group", options.group, 0, most);
  reader.read("mask", options.mask, 0, most);
  reader.read("max_level", options.octree.max_level, 0, 32);
  reader.read("leaf_size", options.octree.leaf_size, 1, most);
  return options;
}

std::optional<Sway> read_motion(TomlReader& object, const fs::path& path, const std::string& where) {
  const toml::table* table = object.table("motion");
  if (!table) return std::nullopt;
  TomlReader reader(path, *table, where + ": motion");
  std::string kind;
  reader.read("kind", kind);
  if (kind != "sway") reader.fail("kind", "must be kind = \"sway\"");
  Sway motion;
  reader.read("velocity", motion.velocity);
  reader.read("amplitude", motion.amplitude);
  reader.read_positive("wavelength", motion.wavelength);
  reader.read_positive("period", motion.period);
  reader.read("seed", motion.seed);
  reader.finish();
  return motion;
}

InputObject read_object(const toml::table& table, const fs::path& path, const std::string& where,
                        Shapes& shapes) {
  TomlReader reader(path, table, where);
  InputObject object;
  object.options = read_options(reader);
  const Placement placement = read_placement(reader);
  object.motion = read_motion(reader, path, where);
  if (object.motion && object.options.is_static)
    reader.fail("motion", "a static object does not move; leave out motion or static");
  object.mesh = read_shape(reader, path.parent_path(), shapes);
  reader.finish();
  place(object.mesh.positions, placement);
  if (!object.options.name.empty()) object.mesh.name = object.options.name;
  return object;
}

void read_scene(const toml::table& table, const fs::path& path, Input& input) {
  TomlReader reader(path, table, "[scene]");
  Bounds bounds;
  reader.read_points("bounds", bounds.data(), bounds.size());
  if (reader.has("bounds")) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(bounds[0][axis] < bounds[1][axis]))
        reader.fail("bounds", "each coordinate of the first corner must be below the second's");
    }
    input.bounds = bounds;
  }
  reader.read_positive("time_step", input.time_step);
  reader.finish();
}

}  // namespace

Input read_scene_file(const fs::path& path) {
  const toml::table file = parse_toml(path);
  TomlReader reader(path, file, "scene file");
  Input input;
  if (const toml::table* scene = reader.table("scene")) read_scene(*scene, path, input);
  const std::vector<const toml::table*> objects = reader.tables("object");
  reader.finish();
  Shapes shapes;
  for (std::size_t i = 0; i < objects.size(); ++i)
    input.objects.push_back(read_object(*objects[i], path, fmt::format("[[object]] {}", i), shapes));
  if (input.objects.empty())
    throw Error(fmt::format("{}: has no objects; add an [[object]] with mesh or model", path.string()));
  return input;
}

}  // namespace supple::cli
