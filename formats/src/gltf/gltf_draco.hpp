#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "gltf/gltf_file.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// A decoded mesh of KHR_draco_mesh_compression.
class DracoMesh {
 public:
  /// Fails with the place of `extension` when the bytes are damaged.
  DracoMesh(const GltfValue& extension, std::string_view bytes);
  ~DracoMesh();
  DracoMesh(const DracoMesh&) = delete;
  DracoMesh& operator=(const DracoMesh&) = delete;

  std::vector<Triangle> triangles() const;
  /// The numbers of the attribute, such as POSITION; nothing when the extension does not have it.
  std::optional<GltfNumbers> attribute(const GltfValue& extension, const char* name, std::size_t width) const;

 private:
  struct Content;
  Content* content_;
};

}  // namespace supple
