#include "animation/model_readers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "files/number_text.hpp"
#include "gltf/gltf_draco.hpp"
#include "gltf/gltf_file.hpp"

namespace supple {
namespace {

Vec3d vector_at(const GltfNumbers& numbers, std::uint64_t i) {
  const double* values = numbers.values.data() + i * numbers.width;
  return {values[0], values[1], values[2]};
}

std::vector<Vec3d> vectors(const GltfNumbers& numbers) {
  std::vector<Vec3d> result;
  result.reserve(numbers.count);
  for (std::uint64_t i = 0; i < numbers.count; ++i) result.push_back(vector_at(numbers, i));
  return result;
}

/// The transform of 16 numbers, column by column. `place` is where they are.
Transform transform_of(const double* values, const GltfValue& place) {
  Transform result;
  // Some exporters round the last row.
  constexpr double rounding = 1e-5;
  for (std::size_t column = 0; column < 4; ++column) {
    if (!(std::abs(values[4 * column + 3] - (column == 3 ? 1 : 0)) <= rounding))
      place.fail_here(
          "the last row of a matrix is not 0 0 0 1, as glTF demands; projections are not supported");
  }
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) result[row][column] = values[4 * column + row];
  }
  return result;
}

Vec3d vector_of(const GltfValue& value, const Vec3d& absent) {
  if (!value) return absent;
  const std::vector<double> numbers = value.numbers(3);
  return {numbers[0], numbers[1], numbers[2]};
}

/// The triangles of a list, a strip (mode 5) or a fan (mode 6) of vertices.
std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& ids, std::uint64_t mode) {
  std::vector<Triangle> triangles;
  if (mode == 4) {
    for (std::size_t i = 0; i + 2 < ids.size(); i += 3) triangles.push_back({ids[i], ids[i + 1], ids[i + 2]});
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < ids.size(); ++i) {
    if (mode == 6)
      triangles.push_back({ids[i + 1], ids[i + 2], ids[0]});
    else if (i % 2 == 0)
      triangles.push_back({ids[i], ids[i + 1], ids[i + 2]});
    else
      triangles.push_back({ids[i], ids[i + 2], ids[i + 1]});
  }
  return triangles;
}

/// A number of a file that should be an index.
std::string shown_index(double number) {
  constexpr double most = 4294967296;
  return number >= 0 && number < most && number == std::floor(number)
             ? std::to_string(static_cast<std::uint64_t>(number))
             : std::to_string(number);
}

class GltfReader {
 public:
  explicit GltfReader(const std::filesystem::path& path) : file_(path), root_(file_.root()) {}

  AnimatedModel read() {
    model_.frame = {UpAxis::y, 1};
    read_nodes();
    read_skins();
    for (const std::uint32_t node : nodes_of_scene()) read_mesh_of(node);
    const GltfValue animations = root_["animations"];
    for (std::uint64_t i = 0; i < animations.size(); ++i) read_clip(animations.at(i), i);
    model_.finish(file_.name());
    return std::move(model_);
  }

 private:
  /// The numbers of an attribute of a primitive. With Draco, the accessor only describes them.
  std::optional<GltfNumbers> attribute(const GltfValue& primitive, const DracoMesh* draco, const char* name,
                                       std::string_view type) {
    if (draco != nullptr) {
      auto numbers = draco->attribute(primitive["extensions"]["KHR_draco_mesh_compression"], name,
                                      type == "VEC4" ? 4 : 3);
      if (numbers) return numbers;
    }
    const GltfValue index = primitive["attributes"][name];
    if (!index) return std::nullopt;
    return read_accessor(file_, index, type);
  }

  Surface read_primitive(const GltfValue& primitive) {
    Surface surface;
    const std::uint64_t mode = primitive["mode"].whole_or(4);
    if (mode < 4) return surface;  // points and lines
    if (mode > 6) primitive["mode"].fail_here("is not a kind of primitives that glTF has");
    std::optional<DracoMesh> draco;
    const GltfValue extension = primitive["extensions"]["KHR_draco_mesh_compression"];
    if (extension) {
      const std::uint64_t views = root_["bufferViews"].size();
      draco.emplace(extension, file_.view(extension["bufferView"].index(views, "buffer view")));
    }
    const DracoMesh* compressed = draco ? &*draco : nullptr;
    const auto points = attribute(primitive, compressed, "POSITION", "VEC3");
    if (!points) return surface;  // what an extension gives a shape, which this reader does not know
    surface.points = vectors(*points);
    surface.triangles = compressed ? compressed->triangles() : read_triangles(primitive, mode, points->count);
    for (const Triangle& triangle : surface.triangles) {
      if (*std::max_element(triangle.begin(), triangle.end()) >= points->count)
        extension.fail_here("a triangle has a vertex that is not in the data; export the file again");
    }
    read_targets(primitive["targets"], surface);
    read_influences(primitive, compressed, surface);
    return surface;
  }

  std::vector<Triangle> read_triangles(const GltfValue& primitive, std::uint64_t mode, std::uint64_t points) {
    std::vector<std::uint32_t> ids;
    if (!primitive["indices"]) {
      for (std::uint64_t i = 0; i < points; ++i) ids.push_back(static_cast<std::uint32_t>(i));
      return triangles_of(ids, mode);
    }
    const GltfNumbers numbers = read_accessor(file_, primitive["indices"], "SCALAR");
    ids.reserve(numbers.count);
    for (const double number : numbers.values) {
      if (!(number >= 0 && number < static_cast<double>(points)) || number != std::floor(number))
        primitive["indices"].fail_here("vertex index " + shown_index(number) +
                                       " is out of range; the primitive has " + std::to_string(points) +
                                       " vertices, counted from 0");
      ids.push_back(static_cast<std::uint32_t>(number));
    }
    return triangles_of(ids, mode);
  }

  void read_targets(const GltfValue& targets, Surface& surface) {
    for (std::uint64_t i = 0; i < targets.size(); ++i) {
      const GltfValue position = targets.at(i)["POSITION"];
      std::vector<Vec3d>& target = surface.targets.emplace_back(surface.points.size());
      if (position) target = vectors(read_accessor(file_, position, "VEC3"));
      if (target.size() != surface.points.size())
        position.fail_here("has " + std::to_string(target.size()) + " elements, but the primitive has " +
                           std::to_string(surface.points.size()) + " vertices");
    }
  }

  void read_influences(const GltfValue& primitive, const DracoMesh* draco, Surface& surface) {
    for (int set = 0;; ++set) {
      const std::string number = std::to_string(set);
      const auto joints = attribute(primitive, draco, ("JOINTS_" + number).c_str(), "VEC4");
      const auto weights = attribute(primitive, draco, ("WEIGHTS_" + number).c_str(), "VEC4");
      if (!joints || !weights) return;
      if (joints->count != surface.points.size() || weights->count != surface.points.size())
        primitive["attributes"].fail_here("joints, weights and positions have different counts");
      surface.influences.resize(surface.points.size());
      for (std::size_t i = 0; i < 4 * surface.points.size(); ++i) {
        const double joint = joints->values[i];
        const double weight = weights->values[i];
        if (!(weight > 0)) continue;
        if (!(joint >= 0 && joint < 65536))
          primitive["attributes"].fail_here("a joint is not a number of a joint");
        surface.influences[i / 4].push_back({static_cast<std::uint32_t>(joint), weight});
      }
    }
  }

  void read_nodes() {
    const GltfValue nodes = root_["nodes"];
    model_.nodes.resize(nodes.size());
    for (std::uint32_t i = 0; i < model_.nodes.size(); ++i) {
      const GltfValue value = nodes.at(i);
      ModelNode& node = model_.nodes[i];
      if (value["matrix"]) node.matrix = transform_of(value["matrix"].numbers(16).data(), value["matrix"]);
      node.translation = vector_of(value["translation"], node.translation);
      node.scale = vector_of(value["scale"], node.scale);
      if (const GltfValue rotation = value["rotation"]) {
        const std::vector<double> q = rotation.numbers(4);
        node.rotation = {q[0], q[1], q[2], q[3]};
      }
      if (value["weights"]) node.weights = value["weights"].numbers(value["weights"].size());
      const GltfValue children = value["children"];
      for (std::uint64_t k = 0; k < children.size(); ++k) {
        const std::uint32_t child = children.at(k).index(model_.nodes.size(), "node");
        if (model_.nodes[child].parent != ModelNode::no_parent)
          children.at(k).fail_here("node " + std::to_string(child) + " has two parents");
        model_.nodes[child].parent = i;
      }
    }
  }

  void read_skins() {
    const GltfValue skins = root_["skins"];
    for (std::uint64_t i = 0; i < skins.size(); ++i) {
      const GltfValue joints = skins.at(i)["joints"], matrices = skins.at(i)["inverseBindMatrices"];
      ModelSkin& skin = model_.skins.emplace_back();
      for (std::uint64_t k = 0; k < joints.size(); ++k)
        skin.joints.push_back(joints.at(k).index(model_.nodes.size(), "node"));
      skin.inverse_bind.resize(skin.joints.size(), identity_transform);
      if (!matrices) continue;
      const GltfNumbers numbers = read_accessor(file_, matrices, "MAT4");
      if (numbers.count < skin.joints.size())
        matrices.fail_here("has fewer matrices than the skin has joints");
      for (std::size_t k = 0; k < skin.joints.size(); ++k)
        skin.inverse_bind[k] = transform_of(numbers.values.data() + 16 * k, matrices);
    }
  }

  /// The nodes of the scene, depth first: a node comes before its children, and they keep their order. A file
  /// without scenes shows all nodes.
  std::vector<std::uint32_t> nodes_of_scene() {
    std::vector<std::uint32_t> stack, result;
    const GltfValue scenes = root_["scenes"];
    if (scenes.size() > 0) {
      const std::uint64_t scene = root_["scene"] ? root_["scene"].index(scenes.size(), "scene") : 0;
      const GltfValue roots = scenes.at(scene)["nodes"];
      for (std::uint64_t i = roots.size(); i-- > 0;)
        stack.push_back(roots.at(i).index(model_.nodes.size(), "node"));
    } else {
      for (auto i = static_cast<std::uint32_t>(model_.nodes.size()); i-- > 0;) {
        if (model_.nodes[i].parent == ModelNode::no_parent) stack.push_back(i);
      }
    }
    std::vector<bool> is_visited(model_.nodes.size());
    while (!stack.empty()) {
      const std::uint32_t node = stack.back();
      stack.pop_back();
      if (is_visited[node]) continue;
      is_visited[node] = true;
      result.push_back(node);
      const GltfValue children = root_["nodes"].at(node)["children"];
      for (std::uint64_t i = children.size(); i-- > 0;)
        stack.push_back(children.at(i).index(model_.nodes.size(), "node"));
    }
    return result;
  }

  void read_mesh_of(std::uint32_t node) {
    const GltfValue value = root_["nodes"].at(node), meshes = root_["meshes"];
    if (!value["mesh"]) return;
    const GltfValue mesh = meshes.at(value["mesh"].index(meshes.size(), "mesh"));
    std::vector<Surface> surfaces;
    const GltfValue primitives = mesh["primitives"];
    for (std::uint64_t i = 0; i < primitives.size(); ++i)
      surfaces.push_back(read_primitive(primitives.at(i)));
    ModelPart part;
    part.node = node;
    if (mesh["weights"]) part.weights = mesh["weights"].numbers(mesh["weights"].size());
    const bool is_skinned =
        value["skin"] && std::any_of(surfaces.begin(), surfaces.end(),
                                     [](const Surface& surface) { return !surface.influences.empty(); });
    if (is_skinned) {
      part.skin = value["skin"].index(model_.skins.size(), "skin");
      check_joints(value["skin"], model_.skins[*part.skin], surfaces);
    }
    for (const Transform& instance : instances(value["extensions"]["EXT_mesh_gpu_instancing"])) {
      part.local = instance;
      model_.add_part(part, surfaces, file_.name());
    }
  }

  static void check_joints(const GltfValue& place, const ModelSkin& skin,
                           const std::vector<Surface>& surfaces) {
    for (const Surface& surface : surfaces) {
      for (const auto& influences : surface.influences) {
        for (const Influence& influence : influences) {
          if (influence.joint >= skin.joints.size())
            place.fail_here("a vertex follows joint " + std::to_string(influence.joint) +
                            ", but the skin has " + std::to_string(skin.joints.size()) + ", counted from 0");
        }
      }
    }
  }

  std::vector<Transform> instances(const GltfValue& extension) {
    if (!extension) return {identity_transform};
    const GltfValue attributes = extension["attributes"];
    const auto read = [&](const char* name, std::string_view type) {
      return attributes[name] ? std::optional(read_accessor(file_, attributes[name], type)) : std::nullopt;
    };
    const auto translation = read("TRANSLATION", "VEC3"), rotation = read("ROTATION", "VEC4"),
               scale = read("SCALE", "VEC3");
    std::uint64_t count = 0;
    for (const auto* given : {&translation, &rotation, &scale}) {
      if (!*given) continue;
      if (count != 0 && (*given)->count != count)
        attributes.fail_here("the attributes have different counts");
      count = (*given)->count;
    }
    std::vector<Transform> result;
    for (std::uint64_t i = 0; i < count; ++i) {
      Quaternion q{0, 0, 0, 1};
      if (rotation) std::copy_n(rotation->values.data() + 4 * i, 4, q.begin());
      result.push_back(compose(translation ? vector_at(*translation, i) : Vec3d{}, q,
                               scale ? vector_at(*scale, i) : Vec3d{1, 1, 1}));
    }
    return result;
  }

  void read_clip(const GltfValue& animation, std::uint64_t number) {
    const GltfValue channels = animation["channels"];
    std::vector<AnimationTrack> tracks;
    for (std::uint64_t i = 0; i < channels.size(); ++i) {
      std::vector<AnimationTrack> targets = targets_of(channels.at(i)["target"]);
      if (targets.empty()) continue;
      const GltfValue samplers = animation["samplers"];
      read_keys(samplers.at(channels.at(i)["sampler"].index(samplers.size(), "sampler")), targets[0]);
      if (targets[0].times.empty()) continue;
      for (AnimationTrack& track : targets) {
        const std::uint32_t node = track.node;
        track = targets[0];
        track.node = node;
        if (track.weight) add_weights(node);
      }
      tracks.insert(tracks.end(), targets.begin(), targets.end());
    }
    if (tracks.empty()) return;
    AnimationClip clip{animation["name"].text_or("clip " + std::to_string(number)), tracks[0].times.front(),
                       tracks[0].times.back()};
    for (const AnimationTrack& track : tracks) {
      clip.start = std::min(clip.start, track.times.front());
      clip.end = std::max(clip.end, track.times.back());
    }
    model_.clips.push_back(std::move(clip));
    model_.tracks.push_back(std::move(tracks));
  }

  /// Tracks without keys for what a channel animates. None for other things than the shape, such as colours.
  std::vector<AnimationTrack> targets_of(const GltfValue& target) const {
    std::string path = target["path"].text_or("");
    std::vector<std::uint32_t> nodes;
    std::optional<std::uint32_t> weight;
    if (path == "pointer") {
      // "/nodes/3/translation", "/nodes/3/weights/0" or "/meshes/1/weights"
      const GltfValue pointer = target["extensions"]["KHR_animation_pointer"]["pointer"];
      std::vector<std::string> parts;
      std::string part;
      for (std::istringstream text(pointer.text_or("")); std::getline(text, part, '/');)
        parts.push_back(part);
      if (parts.size() < 4 || parts.size() > 5 || !parts[0].empty()) return {};
      const std::optional<std::uint32_t> id = index_of(parts[2]);
      if (parts.size() == 5) weight = index_of(parts[4]);
      path = parts[3];
      if (!id || (parts.size() == 5 && (path != "weights" || !weight))) return {};
      if (parts[1] == "nodes") {
        if (*id >= model_.nodes.size()) pointer.fail_here("there is no node " + parts[2]);
        nodes = {*id};
      } else if (parts[1] == "meshes" && path == "weights") {
        for (std::uint32_t i = 0; i < model_.nodes.size(); ++i) {
          const GltfValue node = root_["nodes"].at(i);
          if (node["mesh"] && node["mesh"].whole() == *id && !node["weights"]) nodes.push_back(i);
        }
      }
    } else if (target["node"]) {
      nodes = {target["node"].index(model_.nodes.size(), "node")};
    }
    constexpr std::array properties = {"translation", "rotation", "scale", "weights"};
    const auto property = std::find(properties.begin(), properties.end(), path);
    std::vector<AnimationTrack> tracks;
    for (const std::uint32_t node : nodes) {
      if (property == properties.end()) break;
      AnimationTrack& track = tracks.emplace_back();
      track.node = node;
      track.property = static_cast<Animated>(property - properties.begin());
      track.weight = weight;
    }
    return tracks;
  }

  static std::optional<std::uint32_t> index_of(const std::string& text) {
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    if (parse_integer(text.data(), end, value) != end || value < 0 || value > 0xffffffff) return {};
    return static_cast<std::uint32_t>(value);
  }

  /// A track of one weight changes only this one, so the node needs all of them.
  void add_weights(std::uint32_t node) {
    std::vector<double>& weights = model_.nodes[node].weights;
    for (const ModelPart& part : model_.parts) {
      if (part.node != node) continue;
      if (weights.empty()) weights = part.weights;
      weights.resize(std::max(weights.size(), part.targets.size()));
    }
  }

  void read_keys(const GltfValue& sampler, AnimationTrack& track) {
    const std::string interpolation = sampler["interpolation"].text_or("LINEAR");
    if (interpolation == "STEP")
      track.interpolation = Interpolation::step;
    else if (interpolation == "CUBICSPLINE")
      track.interpolation = Interpolation::cubic_spline;
    else if (interpolation != "LINEAR")
      sampler["interpolation"].fail_here("is not one of STEP, LINEAR and CUBICSPLINE");
    track.times = read_accessor(file_, sampler["input"], "SCALAR").values;
    const bool is_ascending =
        std::adjacent_find(track.times.begin(), track.times.end(),
                           [](double a, double b) { return !(a <= b); }) == track.times.end();
    if (!is_ascending ||
        !std::all_of(track.times.begin(), track.times.end(), [](double time) { return std::isfinite(time); }))
      sampler["input"].fail_here("the times of the keys must be finite and increase");
    const std::string_view type = track.property == Animated::rotation  ? "VEC4"
                                  : track.property == Animated::weights ? "SCALAR"
                                                                        : "VEC3";
    track.values = read_accessor(file_, sampler["output"], type).values;
    if (track.times.empty()) return;
    const std::size_t parts =
        track.times.size() * (track.interpolation == Interpolation::cubic_spline ? 3 : 1);
    const std::size_t width = type == "VEC4" ? 4 : type == "VEC3" ? 3 : track.values.size() / parts;
    if (width == 0 || track.values.size() != parts * width)
      sampler["output"].fail_here("has " + std::to_string(track.values.size()) + " numbers for " +
                                  std::to_string(track.times.size()) + " keys");
  }

  GltfFile file_;
  GltfValue root_;
  AnimatedModel model_;
};

}  // namespace

AnimatedModel read_gltf(const std::filesystem::path& path) {
  return GltfReader(path).read();
}

}  // namespace supple
