#include "gltf/gltf_draco.hpp"

#include <draco/compression/decode.h>

#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "core/quotes.hpp"

namespace supple {

struct DracoMesh::Content {
  std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh(const GltfValue& extension, std::string_view bytes) : content_(nullptr) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    extension.fail_here("the data are damaged (" + one_line(decoded.status().error_msg_string()) +
                        "); export the file again");
  content_ = new Content{std::move(decoded).value()};
}

DracoMesh::~DracoMesh() {
  delete content_;
}

std::vector<Triangle> DracoMesh::triangles() const {
  std::vector<Triangle> triangles;
  triangles.reserve(content_->mesh->num_faces());
  for (draco::FaceIndex i(0); i < content_->mesh->num_faces(); ++i) {
    const draco::Mesh::Face& face = content_->mesh->face(i);
    triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return triangles;
}

std::optional<GltfNumbers> DracoMesh::attribute(const GltfValue& extension, const char* name,
                                                std::size_t width) const {
  const GltfValue id = extension["attributes"][name];
  if (!id) return std::nullopt;
  const draco::PointAttribute* attribute = content_->mesh->GetAttributeByUniqueId(
      id.index(std::numeric_limits<std::uint32_t>::max(), "attribute"));
  if (attribute == nullptr || static_cast<std::size_t>(attribute->num_components()) != width)
    id.fail_here("the data have no such attribute of " + std::to_string(width) + " numbers");
  GltfNumbers numbers{content_->mesh->num_points(), width, {}};
  numbers.values.reserve(numbers.count * width);
  std::array<double, 4> element{};
  for (draco::PointIndex i(0); i < content_->mesh->num_points(); ++i) {
    attribute->ConvertValue<double>(attribute->mapped_index(i), static_cast<std::int8_t>(width),
                                    element.data());
    numbers.values.insert(numbers.values.end(), element.begin(),
                          element.begin() + static_cast<std::ptrdiff_t>(width));
  }
  return numbers;
}

}  // namespace supple
