#include "assimp/assimp_frame.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace supple {
namespace {

template <std::size_t Count>
bool contains(const std::array<std::string_view, Count>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The double with the shortest decimal notation of the float: 0.01 for the float next to it.
double as_written(float value) {
  std::array<char, 64> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double result = 0;
  std::from_chars(text.data(), end, result);
  return result;
}

/// Assimp multiplies the root by the unit and by a turn to y up.
CoordinateFrame frame_of_collada(const Transform& root) {
  CoordinateFrame frame{UpAxis::y, 0};
  double unit = root[2][2];
  if (root[1][2] != 0) {
    frame.up = UpAxis::z;
    unit = root[1][2];
  } else if (root[1][0] != 0) {
    frame.up = UpAxis::x;
  }
  if (std::isfinite(unit) && unit > 0) frame.unit = as_written(static_cast<float>(unit));
  return frame;
}

CoordinateFrame frame_of_fbx(const aiScene& scene) {
  CoordinateFrame frame;
  if (scene.mMetaData == nullptr) return frame;
  std::int32_t axis = -1, sign = 1;
  float centimetres = 0;
  scene.mMetaData->Get("UpAxis", axis);
  scene.mMetaData->Get("UpAxisSign", sign);
  scene.mMetaData->Get("UnitScaleFactor", centimetres);
  if (axis >= 0 && axis <= 2 && sign > 0) frame.up = static_cast<UpAxis>(axis + 1);
  if (std::isfinite(centimetres) && centimetres > 0) frame.unit = as_written(centimetres) / 100;
  return frame;
}

/// The root of IFC is a turn from z up to y up, times the metres of a unit, times the coordinate system of
/// the file. The turn has rounding errors; where it leaves nothing else, so does this.
Transform without_turn(const Transform& root) {
  Transform result = {{root[0], {}, root[1]}};
  for (std::size_t i = 0; i < 4; ++i) {
    result[1][i] = -root[2][i];
    result[2][i] = root[1][i];
  }
  const double scale = result[0][0];
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const double expected = row == column ? scale : 0;
      if (!(std::abs(result[row][column] - expected) <= 1e-6 * std::abs(scale))) return result;
    }
  }
  return {{{scale, 0, 0, 0}, {0, scale, 0, 0}, {0, 0, scale, 0}}};
}

}  // namespace

bool is_mirrored_by_assimp(std::string_view extension) {
  constexpr std::array<std::string_view, 9> mirrored = {".b3d", ".lwo", ".lws", ".lxo", ".mot",
                                                        ".pmx", ".uc",  ".x",   ".3d"};
  return contains(mirrored, extension);
}

Transform transform_of(const aiMatrix4x4& matrix) {
  Transform result;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 4; ++column)
      result[row][column] = static_cast<double>(matrix[row][column]);
  }
  return result;
}

RootFrame root_frame_of(const aiScene& scene, std::string_view extension) {
  // Assimp turns these from z up to y up. 3DS has also a master scale, which is for display.
  constexpr std::array<std::string_view, 13> turned = {".3ds", ".ase", ".ask",     ".dxf",     ".iqm",
                                                       ".md2", ".md3", ".md5anim", ".md5mesh", ".md5camera",
                                                       ".mdc", ".mdl", ".prj"};
  const Transform root = transform_of(scene.mRootNode->mTransformation);
  if (extension == ".dae" || extension == ".zae") return {frame_of_collada(root), identity_transform};
  if (extension == ".fbx") return {frame_of_fbx(scene), root};
  if (extension == ".ifc" || extension == ".ifczip") return {{UpAxis::z, 1}, without_turn(root)};
  if (contains(turned, extension)) return {{UpAxis::z, 0}, identity_transform};
  return {{}, root};
}

}  // namespace supple
