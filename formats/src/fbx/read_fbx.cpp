// FBX, by ufbx (https://github.com/ufbx/ufbx), which evaluates animations as the programs of their authors
// do.

#ifdef SUPPLE_UFBX_SOURCES
#include "fbx/own_ufbx.hpp"
#else
#include <ufbx.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "animation/model_readers.hpp"
#include "core/error.hpp"
#include "core/quotes.hpp"
#include "files/file_access.hpp"
#include "files/polygon/polygon.hpp"

namespace supple {
namespace {

struct FreeScene {
  void operator()(ufbx_scene* scene) const { ufbx_free_scene(scene); }
};
using Scene = std::unique_ptr<ufbx_scene, FreeScene>;

std::string text_of(const ufbx_string& text) {
  return {text.data, text.length};
}

Vec3d vector_of(const ufbx_vec3& v) {
  return {v.x, v.y, v.z};
}

std::string reason_of(const ufbx_error& error) {
  std::string reason = error.type == UFBX_ERROR_UNKNOWN
                           ? "its content is damaged, or an index is out of range"
                           : text_of(error.description);
  if (error.info_length > 0) reason += ": " + std::string(error.info, error.info_length);
  return one_line(reason);
}

/// A mesh at a node. The ids are those that elements have in the scene and in each evaluation of it.
struct Instance {
  std::uint32_t mesh, node;
  std::size_t first_vertex;
};

class FbxFile {
 public:
  FbxFile(std::string_view bytes, std::string file)
      : file_(std::move(file)), most_bytes_((std::size_t{64} << 20) + 200 * bytes.size()) {
    ufbx_load_opts options{};
    limit(options);
    options.file_format = UFBX_FILE_FORMAT_FBX;
    options.ignore_embedded = true;
    options.skip_mesh_parts = true;
    options.index_error_handling = UFBX_INDEX_ERROR_HANDLING_NO_INDEX;
    ufbx_error error;
    scene_.reset(ufbx_load_memory(bytes.data(), bytes.size(), &options, &error));
    if (!scene_) fail_by(error);
  }

  AnimatedModel read() {
    read_frame();
    add_instances();
    read_clips();
    place(*scene_, model_.mesh.positions);
    turn_mirrored_triangles();
    return std::move(model_);
  }

  /// The positions at a time of a clip.
  void pose(std::size_t clip, double time, std::span<Vec3d> positions) const {
    ufbx_evaluate_opts options{};
    limit(options);
    ufbx_error error;
    const ufbx_anim_stack& stack = *scene_->anim_stacks.data[stacks_[clip]];
    const Scene posed(ufbx_evaluate_scene(scene_.get(), stack.anim, time, &options, &error));
    if (!posed) fail_by(error);
    place(*posed, positions);
  }

 private:
  template <class Options>
  void limit(Options& options) const {
    options.temp_allocator.memory_limit = most_bytes_;
    options.result_allocator.memory_limit = most_bytes_;
  }

  [[noreturn]] void fail_by(const ufbx_error& error) const {
    if (error.type == UFBX_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    fail("cannot read " + file_ + ": " +
         (error.type == UFBX_ERROR_MEMORY_LIMIT
              ? "its content needs more than 64 MiB and 200 times its size; compress it less"
              : reason_of(error) + "; is the file complete? Export it again, or as glTF"));
  }

  void read_frame() {
    const ufbx_scene_settings& settings = scene_->settings;
    const auto up = static_cast<int>(settings.axes.up);
    // Positive and negative directions of x, y and z take turns.
    if (ufbx_find_prop(&settings.props, "UpAxis") != nullptr &&
        settings.axes.up != UFBX_COORDINATE_AXIS_UNKNOWN && up % 2 == 0)
      model_.frame.up = static_cast<UpAxis>(up / 2 + 1);
    const double centimetres = ufbx_find_real(&settings.props, "UnitScaleFactor", 0);
    if (std::isfinite(centimetres) && centimetres > 0) model_.frame.unit = centimetres / 100;
  }

  /// Depth first: a node comes before its children, and the children keep their order.
  void add_instances() {
    std::vector<const ufbx_node*> stack = {scene_->root_node};
    while (!stack.empty()) {
      const ufbx_node& node = *stack.back();
      stack.pop_back();
      for (std::size_t i = 0; i < node.all_attribs.count; ++i) {
        if (const ufbx_mesh* mesh = ufbx_as_mesh(node.all_attribs.data[i])) add_instance(*mesh, node);
      }
      for (std::size_t i = node.children.count; i-- > 0;) stack.push_back(node.children.data[i]);
    }
  }

  void add_instance(const ufbx_mesh& mesh, const ufbx_node& node) {
    instances_.push_back({mesh.typed_id, node.typed_id, model_.mesh.positions.size()});
    first_triangles_.push_back(model_.mesh.triangles.size());
    const std::uint64_t end = model_.mesh.positions.size() + std::uint64_t{mesh.num_vertices};
    if (end > std::numeric_limits<std::uint32_t>::max())
      fail(file_ + ": more vertices than ids can tell; split the file");
    const TriangleMesh cut = triangles_of(mesh);
    const auto first = static_cast<std::uint32_t>(model_.mesh.positions.size());
    for (Triangle triangle : cut.triangles) {
      for (std::uint32_t& id : triangle) id += first;
      model_.mesh.triangles.push_back(triangle);
    }
    model_.mesh.positions.resize(end);
    add(model_.mesh.polygons, cut.polygons);
  }

  static TriangleMesh triangles_of(const ufbx_mesh& mesh) {
    TriangleMesh cut;
    for (std::size_t i = 0; i < mesh.num_vertices; ++i)
      cut.positions.push_back(vector_of(mesh.vertices.data[i]));
    std::vector<PolygonFan> fans;
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < mesh.faces.count; ++i) {
      const ufbx_face face = mesh.faces.data[i];
      if (face.num_indices < 3) continue;  // points and lines
      if (i < mesh.face_hole.count && mesh.face_hole.data[i]) continue;
      corners.clear();
      for (std::size_t k = 0; k < face.num_indices; ++k)
        corners.push_back(mesh.vertex_indices.data[face.index_begin + k]);
      add_face(cut, fans, corners);
    }
    cut_polygons(cut, fans);
    return cut;
  }

  /// Computes all positions from the nodes, bones and weights of the scene or of an evaluation.
  void place(const ufbx_scene& posed, std::span<Vec3d> positions) const {
    std::vector<ufbx_vec3> points;
    for (const Instance& instance : instances_) {
      const ufbx_mesh& mesh = *posed.meshes.data[instance.mesh];
      const ufbx_matrix& to_world = posed.nodes.data[instance.node]->geometry_to_world;
      points.assign(mesh.vertices.data, mesh.vertices.data + mesh.num_vertices);
      for (std::size_t i = 0; i < mesh.blend_deformers.count; ++i)
        ufbx_add_blend_vertex_offsets(mesh.blend_deformers.data[i], points.data(), points.size(), 1);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const ufbx_matrix map = matrix_of(mesh, i, to_world);
        positions[instance.first_vertex + i] = vector_of(ufbx_transform_position(&map, points[i]));
      }
    }
  }

  /// The matrix of a vertex: that of its skin, or of its node.
  static ufbx_matrix matrix_of(const ufbx_mesh& mesh, std::size_t vertex, const ufbx_matrix& to_world) {
    if (mesh.skin_deformers.count == 0) return to_world;
    return ufbx_get_skin_vertex_matrix(mesh.skin_deformers.data[0], vertex, &to_world);
  }

  void turn_mirrored_triangles() {
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      const ufbx_mesh& mesh = *scene_->meshes.data[instances_[i].mesh];
      if (mesh.num_vertices == 0) continue;
      const ufbx_matrix& to_world = scene_->nodes.data[instances_[i].node]->geometry_to_world;
      const ufbx_matrix map = matrix_of(mesh, 0, to_world);
      if (!(ufbx_matrix_determinant(&map) < 0)) continue;
      const std::size_t end =
          i + 1 < instances_.size() ? first_triangles_[i + 1] : model_.mesh.triangles.size();
      for (std::size_t k = first_triangles_[i]; k < end; ++k)
        std::swap(model_.mesh.triangles[k][1], model_.mesh.triangles[k][2]);
    }
  }

  void read_clips() {
    const std::vector<bool> moves_mesh = find_moving_elements();
    for (std::size_t i = 0; i < scene_->anim_stacks.count; ++i) {
      const ufbx_anim_stack& stack = *scene_->anim_stacks.data[i];
      constexpr double never = std::numeric_limits<double>::infinity();
      AnimationClip clip{text_of(stack.name), never, -never};
      bool moves = false;
      for (const ufbx_anim_layer* layer : std::span(stack.layers.data, stack.layers.count)) {
        for (const ufbx_anim_prop& prop : std::span(layer->anim_props.data, layer->anim_props.count)) {
          for (const ufbx_anim_curve* curve : prop.anim_value->curves) {
            if (curve == nullptr || curve->keyframes.count == 0) continue;
            clip.start = std::min(clip.start, curve->keyframes.data[0].time);
            clip.end = std::max(clip.end, curve->keyframes.data[curve->keyframes.count - 1].time);
            moves = moves || moves_mesh[prop.element->element_id];
          }
        }
      }
      if (!moves || !std::isfinite(clip.end - clip.start)) continue;
      if (clip.name.empty()) clip.name = "clip " + std::to_string(i);
      stacks_.push_back(i);
      model_.clips.push_back(std::move(clip));
    }
  }

  /// For each element of the scene, whether its properties move a mesh: nodes, bones and what is above them,
  /// and channels of shapes.
  std::vector<bool> find_moving_elements() const {
    std::vector<bool> moves(scene_->elements.count);
    const auto mark = [&](const ufbx_node* node) {
      for (; node != nullptr && !moves[node->element_id]; node = node->parent) moves[node->element_id] = true;
    };
    for (const Instance& instance : instances_) {
      mark(scene_->nodes.data[instance.node]);
      const ufbx_mesh& mesh = *scene_->meshes.data[instance.mesh];
      for (std::size_t i = 0; i < mesh.skin_deformers.count; ++i) {
        const ufbx_skin_cluster_list& clusters = mesh.skin_deformers.data[i]->clusters;
        for (std::size_t k = 0; k < clusters.count; ++k) mark(clusters.data[k]->bone_node);
      }
      for (std::size_t i = 0; i < mesh.blend_deformers.count; ++i) {
        const ufbx_blend_channel_list& channels = mesh.blend_deformers.data[i]->channels;
        for (std::size_t k = 0; k < channels.count; ++k) moves[channels.data[k]->element_id] = true;
      }
    }
    return moves;
  }

  std::string file_;
  std::size_t most_bytes_;
  Scene scene_;
  std::vector<Instance> instances_;
  std::vector<std::size_t> first_triangles_;  // of each instance
  std::vector<std::size_t> stacks_;           // of each clip
  AnimatedModel model_;
};

}  // namespace

AnimatedModel read_fbx(const std::filesystem::path& path) {
  const auto file = std::make_shared<FbxFile>(read_file(path), shown(path));
  AnimatedModel model = file->read();
  model.evaluate = [file, clips = model.clips](std::size_t clip, double time, std::span<Vec3d> positions) {
    file->pose(clip, std::clamp(time, clips[clip].start, clips[clip].end), positions);
  };
  return model;
}

}  // namespace supple
