#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "mesh/file_access.hpp"
#include "mesh/text_scanner.hpp"
#include "mesh/vertex_welder.hpp"
#include "supple/formats.hpp"

namespace supple {
namespace {

constexpr std::array<std::string_view, 4> native_extensions = {".obj", ".off", ".ply", ".stl"};

// The upper three rows of the matrix that maps points of a node to the scene.
using Transform = std::array<std::array<double, 4>, 3>;
constexpr Transform identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

Transform local_transform(const aiNode& node) {
  Transform result;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      result[row][column] = static_cast<double>(node.mTransformation[row][column]);
    }
  }
  return result;
}

Transform operator*(const Transform& a, const Transform& b) {
  Transform product;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      product[row][column] = a[row][0] * b[0][column] + a[row][1] * b[1][column] + a[row][2] * b[2][column];
    }
    product[row][3] += a[row][3];
  }
  return product;
}

Vec3d operator*(const Transform& m, const Vec3d& p) {
  const auto coordinate = [&](std::size_t row) {
    return m[row][0] * p.x + m[row][1] * p.y + m[row][2] * p.z + m[row][3];
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

bool mirrors(const Transform& m) {
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return determinant < 0;
}

bool is_triangle(const aiFace& face) {
  return face.mNumIndices == 3;
}

// Appends the triangles of all meshes of one node.
class NodeReader {
 public:
  NodeReader(TriangleMesh& mesh, const std::string& file) : mesh_(mesh), file_(file) {}

  void append(const aiScene& scene, const aiNode& node, const Transform& to_scene) {
    const auto first_vertex = static_cast<std::uint32_t>(mesh_.positions.size());
    const std::size_t first_triangle = mesh_.triangles.size();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const unsigned index = node.mMeshes[i];
      if (index >= scene.mNumMeshes) {
        fail(file_ + ": node " + in_quotes(node.mName.C_Str()) + ": mesh " + std::to_string(index) +
             " is out of range; the file has " + std::to_string(scene.mNumMeshes) + ", counted from 0");
      }
      append(*scene.mMeshes[index]);
    }

    // Multiplying by an identity would change infinities and the sign of zero.
    const bool moves = to_scene != identity;
    for (const Vec3d& point : welder_.take_points()) {
      mesh_.positions.push_back(moves ? to_scene * point : point);
    }
    const bool turn_around = mirrors(to_scene);
    for (std::size_t i = first_triangle; i < mesh_.triangles.size(); ++i) {
      Triangle& triangle = mesh_.triangles[i];
      for (std::uint32_t& id : triangle) id += first_vertex;
      if (turn_around) std::swap(triangle[1], triangle[2]);
    }
  }

 private:
  void append(const aiMesh& part) {
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (!is_triangle(face)) continue;
      Triangle triangle;
      for (unsigned corner = 0; corner < 3; ++corner) triangle[corner] = vertex(part, face.mIndices[corner]);
      mesh_.triangles.push_back(triangle);
    }
  }

  std::uint32_t vertex(const aiMesh& part, unsigned index) {
    // Assimp counts the vertices also when it finds no positions.
    if (!part.HasPositions()) {
      fail(file_ + ": mesh " + in_quotes(part.mName.C_Str()) +
           " has triangles but no positions; check how the file stores them");
    }
    if (index >= part.mNumVertices) {
      fail(file_ + ": mesh " + in_quotes(part.mName.C_Str()) + ": vertex index " + std::to_string(index) +
           " is out of range; it has " + std::to_string(part.mNumVertices) + " vertices, counted from 0");
    }
    const aiVector3D& point = part.mVertices[index];
    return welder_.id_of(
        {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)});
  }

  TriangleMesh& mesh_;
  const std::string& file_;
  VertexWelder welder_;
};

// Depth first: a node comes before its children, and the children keep their order.
TriangleMesh fuse(const aiScene& scene, const std::string& file) {
  struct Visit {
    const aiNode* node;
    Transform parent;
  };
  TriangleMesh mesh;
  std::vector<Visit> stack = {{scene.mRootNode, identity}};
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const Transform to_scene = visit.parent * local_transform(*visit.node);
    NodeReader(mesh, file).append(scene, *visit.node, to_scene);
    for (unsigned i = visit.node->mNumChildren; i-- > 0;) {
      stack.push_back({visit.node->mChildren[i], to_scene});
    }
  }
  return mesh;
}

// Parses Assimp's own list, which has the form "*.3d;*.3ds;...".
std::vector<std::string> list_extensions() {
  std::vector<std::string> result(native_extensions.begin(), native_extensions.end());
  aiString list;
  Assimp::Importer().GetExtensionList(list);
  std::string_view rest = list.C_Str();
  while (!rest.empty()) {
    const std::string_view pattern = rest.substr(0, rest.find(';'));
    if (pattern.starts_with("*.")) result.emplace_back(pattern.substr(1));
    rest.remove_prefix(std::min(rest.size(), pattern.size() + 1));
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

std::span<const std::string_view> supported_extensions() {
  static const std::vector<std::string> names = list_extensions();
  static const std::vector<std::string_view> views(names.begin(), names.end());
  return views;
}

bool is_read_by_assimp(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  const std::span<const std::string_view> known = supported_extensions();
  return std::find(native_extensions.begin(), native_extensions.end(), extension) ==
             native_extensions.end() &&
         std::binary_search(known.begin(), known.end(), extension);
}

TriangleMesh load_any_mesh(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  if (std::find(native_extensions.begin(), native_extensions.end(), extension) != native_extensions.end()) {
    return load_mesh(path);
  }
  if (!is_read_by_assimp(path)) {
    fail("cannot read " + shown(path) + ": unknown extension " + in_quotes(extension) +
         "; .obj, .off, .ply, .stl, .gltf, .glb, .fbx, .dae, .3ds and more are supported");
  }
  check_readable(path);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    fail("cannot read " + shown(path) + ": " + one_line(importer.GetErrorString()));
  }
  TriangleMesh mesh = fuse(*scene, shown(path));
  mesh.name = path.stem().string();
  return mesh;
}

}  // namespace supple
