#include "support/truth_data.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "supple/mesh_file.hpp"
#include "support/shared_meshes.hpp"

namespace supple {

std::string sha256(const std::string& text) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_Digest(text.data(), text.size(), digest, &size, EVP_sha256(), nullptr);
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4];
    hex += "0123456789abcdef"[digest[i] & 15];
  }
  return hex;
}

TriangleMesh load_shared_mesh(const std::string& name) {
  return load_mesh(shared_meshes() / name);
}

void transform(TriangleMesh& mesh, const std::string& steps) {
  std::istringstream stream(steps);
  for (std::string step; std::getline(stream, step, ',');) {
    if (step == "-") continue;
    if (step[0] == 't') {
      Vec3d offset;
      std::sscanf(step.c_str(), "t:%lf:%lf:%lf", &offset.x, &offset.y, &offset.z);
      for (Vec3d& p : mesh.positions) p = p + offset;
    } else if (step[0] == 's') {
      for (Vec3d& p : mesh.positions) p = p * std::stod(step.substr(2));
    } else {
      for (Vec3d& p : mesh.positions) {
        Vec3d q;
        for (int axis = 0; axis < 3; ++axis) {
          const double value = p[step[3 + 2 * axis] - 'x'];
          q[axis] = step[2 + 2 * axis] == '-' ? -value : value;
        }
        p = q;
      }
    }
  }
}

std::map<std::array<std::uint32_t, 2>, std::uint32_t> edge_numbers(const TriangleMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> numbers;
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      numbers[{high, low}] = 0;
    }
  }
  std::uint32_t next = 0;
  for (auto& [edge, number] : numbers) number = next++;
  return numbers;
}

}  // namespace supple
