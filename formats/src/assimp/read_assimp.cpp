#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <string>
#include <utility>
#include <vector>

#include "animation/model_readers.hpp"
#include "assimp/assimp_clips.hpp"
#include "assimp/assimp_frame.hpp"
#include "assimp/collada_text.hpp"
#include "core/error.hpp"
#include "core/quotes.hpp"
#include "file_kinds.hpp"
#include "files/file_access.hpp"
#include "files/polygon/polygon.hpp"
#include "files/text_scanner.hpp"

namespace supple {
namespace {

Vec3d vector_of(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

class AssimpReader {
 public:
  AssimpReader(const aiScene& scene, std::string file, const RootFrame& root)
      : scene_(scene), file_(std::move(file)) {
    model_.frame = root.frame;
    add_nodes(root.root);
  }

  AnimatedModel read() {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i]->mNumMeshes > 0) add_part_of(i);
    }
    read_clips(scene_, names_, parts_of_meshes_, model_);
    model_.finish(file_);
    return std::move(model_);
  }

 private:
  /// Depth first: a node comes before its children, and the children keep their order.
  void add_nodes(const Transform& root) {
    std::vector<std::pair<const aiNode*, std::uint32_t>> stack = {{scene_.mRootNode, ModelNode::no_parent}};
    while (!stack.empty()) {
      const auto [node, parent] = stack.back();
      stack.pop_back();
      const auto id = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(node);
      names_.emplace(node->mName.C_Str(), id);
      ModelNode& added = model_.nodes.emplace_back();
      added.parent = parent;
      added.matrix = parent == ModelNode::no_parent ? root : transform_of(node->mTransformation);
      for (unsigned i = node->mNumChildren; i-- > 0;) stack.emplace_back(node->mChildren[i], id);
    }
  }

  void add_part_of(std::uint32_t id) {
    const aiNode& node = *nodes_[id];
    ModelPart part;
    part.node = id;
    ModelSkin skin;
    std::vector<Surface> surfaces;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const unsigned index = node.mMeshes[i];
      if (index >= scene_.mNumMeshes) {
        fail(file_ + ": node " + in_quotes(node.mName.C_Str()) + ": mesh " + std::to_string(index) +
             " is out of range; the file has " + std::to_string(scene_.mNumMeshes) + ", counted from 0");
      }
      const aiMesh& mesh = *scene_.mMeshes[index];
      surfaces.push_back(read_surface(mesh));
      add_influences(mesh, skin, surfaces.back());
      if (part.weights.empty()) part.weights = weights_of(mesh);
      parts_of_meshes_.emplace(mesh.mName.C_Str(), id);
    }
    if (!skin.joints.empty()) {
      part.skin = static_cast<std::uint32_t>(model_.skins.size());
      model_.skins.push_back(std::move(skin));
    }
    model_.add_part(std::move(part), surfaces, file_);
  }

  Surface read_surface(const aiMesh& mesh) const {
    Surface surface;
    for (unsigned i = 0; mesh.HasPositions() && i < mesh.mNumVertices; ++i)
      surface.points.push_back(vector_of(mesh.mVertices[i]));
    read_triangles(mesh, surface);
    for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i) {
      const aiAnimMesh& target = *mesh.mAnimMeshes[i];
      std::vector<Vec3d>& displacements = surface.targets.emplace_back(surface.points.size());
      if (!target.HasPositions() || target.mNumVertices != mesh.mNumVertices) continue;
      for (std::size_t k = 0; k < displacements.size(); ++k) {
        displacements[k] = vector_of(target.mVertices[k]);
        if (mesh.mMethod != aiMorphingMethod_MORPH_RELATIVE)
          displacements[k] = displacements[k] - surface.points[k];
      }
    }
    return surface;
  }

  void read_triangles(const aiMesh& mesh, Surface& surface) const {
    TriangleMesh faces;
    std::vector<PolygonFan> fans;
    std::vector<std::uint32_t> corners;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices < 3) continue;  // points and lines
      corners.clear();
      for (unsigned corner = 0; corner < face.mNumIndices; ++corner)
        corners.push_back(vertex(mesh, face, corner));
      add_face(faces, fans, corners);
    }
    faces.positions = surface.points;
    cut_polygons(faces, fans);
    surface.triangles = std::move(faces.triangles);
    surface.polygons = faces.polygons;
  }

  std::uint32_t vertex(const aiMesh& mesh, const aiFace& face, unsigned corner) const {
    // Assimp counts the vertices also when it finds no positions.
    if (!mesh.HasPositions()) {
      fail(file_ + ": mesh " + in_quotes(mesh.mName.C_Str()) +
           " has triangles but no positions; check how the file stores them");
    }
    const unsigned index = face.mIndices[corner];
    if (index >= mesh.mNumVertices) {
      fail(file_ + ": mesh " + in_quotes(mesh.mName.C_Str()) + ": vertex index " + std::to_string(index) +
           " is out of range; it has " + std::to_string(mesh.mNumVertices) + " vertices, counted from 0");
    }
    return index;
  }

  /// Adds the bones of a mesh to the skin of its node. Bones without a node are left out.
  void add_influences(const aiMesh& mesh, ModelSkin& skin, Surface& surface) const {
    for (unsigned i = 0; i < mesh.mNumBones; ++i) {
      const aiBone& bone = *mesh.mBones[i];
      const auto node = names_.find(bone.mName.C_Str());
      if (node == names_.end()) continue;
      const Transform inverse_bind = transform_of(bone.mOffsetMatrix);
      // Meshes of one node share their bones, so equal vertices of them remain equal.
      std::uint32_t joint = 0;
      while (joint < skin.joints.size() &&
             !(skin.joints[joint] == node->second && skin.inverse_bind[joint] == inverse_bind))
        ++joint;
      if (joint == skin.joints.size()) {
        skin.joints.push_back(node->second);
        skin.inverse_bind.push_back(inverse_bind);
      }
      surface.influences.resize(surface.points.size());
      for (unsigned k = 0; k < bone.mNumWeights; ++k) {
        const aiVertexWeight& weight = bone.mWeights[k];
        if (weight.mVertexId < surface.points.size())
          surface.influences[weight.mVertexId].push_back({joint, static_cast<double>(weight.mWeight)});
      }
    }
  }

  /// The weights of the morph targets at rest. Assimp stores 1 for the weight 0 of COLLADA, and 1 for each
  /// target of FBX.
  static std::vector<double> weights_of(const aiMesh& mesh) {
    std::vector<double> weights;
    for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i) {
      const auto weight = static_cast<double>(mesh.mAnimMeshes[i]->mWeight);
      weights.push_back(weight == 1 ? 0 : weight);
    }
    return weights;
  }

  const aiScene& scene_;
  std::string file_;
  std::vector<const aiNode*> nodes_;
  NodesByName names_, parts_of_meshes_;
  AnimatedModel model_;
};

}  // namespace

AnimatedModel read_with_assimp(const std::filesystem::path& path) {
  check_readable(path);
  const std::string extension = lower_case_extension(path);
  Assimp::Importer importer;
  // Mirroring again gives the coordinates of the file.
  const unsigned steps =
      is_mirrored_by_assimp(extension) ? aiProcess_MakeLeftHanded | aiProcess_FlipWindingOrder : 0u;
  const aiScene* scene = nullptr;
  if (extension == ".dae" || extension == ".zae") {
    const std::string text = collada_text(read_file(path), shown(path));
    scene = importer.ReadFileFromMemory(text.data(), text.size(), steps, "dae");
  } else if (is_utf16(read_start(path))) {
    const std::string text = xml_in_utf8(read_file(path), shown(path));
    scene = importer.ReadFileFromMemory(text.data(), text.size(), steps, extension.c_str() + 1);
  } else {
    scene = importer.ReadFile(path.string(), steps);
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string reason = one_line(importer.GetErrorString());
    // Assimp reads some files of these formats.
    if (const std::string advice = advice_on_extension(extension); !advice.empty())
      fail("cannot read " + shown(path) + ": " + advice +
           (reason.empty() ? "" : " (Assimp: " + reason + ")"));
    fail("cannot read " + shown(path) + ": " +
         (reason.empty() ? "Assimp, which reads this format, gives no reason; save it as OBJ, PLY or glTF"
                         : reason));
  }
  return AssimpReader(*scene, shown(path), root_frame_of(*scene, extension)).read();
}

}  // namespace supple
