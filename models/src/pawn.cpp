#include <array>
#include <utility>

#include "built_in.hpp"
#include "mesh_builder.hpp"

namespace supple::models {

TriangleMesh make_pawn() {
  // 19 rings of 8 vertices and two poles: 154 vertices, 304 faces.
  constexpr std::array<LathePoint, 19> profile{{
      {0.285, 0.000}, {0.315, 0.035}, {0.315, 0.090}, {0.270, 0.135},  // foot
      {0.225, 0.155}, {0.200, 0.205},                                  // step
      {0.150, 0.270}, {0.118, 0.360}, {0.100, 0.460}, {0.100, 0.560},  // stem
      {0.185, 0.605}, {0.190, 0.640}, {0.110, 0.670},                  // collar
      {0.125, 0.712}, {0.168, 0.765}, {0.182, 0.830}, {0.160, 0.905}, {0.115, 0.958}, {0.058, 0.990},  // head
  }};
  MeshBuilder builder;
  builder.add_lathe({0, 0, 0}, {0, 1, 0}, profile, 8, Vec3d{0, 0, 0}, Vec3d{0, 1, 0});
  return std::move(builder).finish("pawn");
}

}  // namespace supple::models
