#include "elements/element_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.hpp"
#include "files/polygon/polygon.hpp"
#include "geometry/exact_predicates.hpp"

namespace supple {
namespace {

constexpr std::size_t most_face_corners = 6;

/// A face of a solid: positions in its list of corners, counter-clockwise seen from outside.
struct FaceShape {
  std::uint8_t corner_count;
  std::array<std::uint8_t, most_face_corners> corners;
};

struct SolidShape {
  std::uint8_t corner_count, face_count;
  std::array<FaceShape, 8> faces;
};

/// In the order of `Solid`.
constexpr std::array<SolidShape, 6> shapes = {{
    {4, 4, {{{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {2, 0, 3}}}}},
    {8,
     6,
     {{{4, {0, 3, 2, 1}},
       {4, {4, 5, 6, 7}},
       {4, {0, 1, 5, 4}},
       {4, {1, 2, 6, 5}},
       {4, {2, 3, 7, 6}},
       {4, {3, 0, 4, 7}}}}},
    {6, 5, {{{3, {0, 2, 1}}, {3, {3, 4, 5}}, {4, {0, 1, 4, 3}}, {4, {1, 2, 5, 4}}, {4, {2, 0, 3, 5}}}}},
    {5, 5, {{{4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}}},
    {10,
     7,
     {{{5, {0, 4, 3, 2, 1}},
       {5, {5, 6, 7, 8, 9}},
       {4, {0, 1, 6, 5}},
       {4, {1, 2, 7, 6}},
       {4, {2, 3, 8, 7}},
       {4, {3, 4, 9, 8}},
       {4, {4, 0, 5, 9}}}}},
    {12,
     8,
     {{{6, {0, 5, 4, 3, 2, 1}},
       {6, {6, 7, 8, 9, 10, 11}},
       {4, {0, 1, 7, 6}},
       {4, {1, 2, 8, 7}},
       {4, {2, 3, 9, 8}},
       {4, {3, 4, 10, 9}},
       {4, {4, 5, 11, 10}},
       {4, {5, 0, 6, 11}}}}},
}};

const SolidShape& shape_of(Solid kind) {
  return shapes[static_cast<std::size_t>(kind)];
}

using Corners = std::span<const std::uint32_t>;

/// The corners of a face without repetitions, which collapsed solids have.
class Loop {
 public:
  Loop(Corners solid, const FaceShape& face) {
    for (std::size_t i = 0; i < face.corner_count; ++i) {
      const std::uint32_t corner = solid[face.corners[i]];
      if (count_ == 0 || corner != corners_[count_ - 1]) corners_[count_++] = corner;
    }
    while (count_ > 1 && corners_[count_ - 1] == corners_[0]) --count_;
  }

  Corners corners() const { return std::span(corners_).first(count_); }
  void turn_around() { std::reverse(corners_.begin() + 1, corners_.begin() + count_); }

 private:
  std::array<std::uint32_t, most_face_corners> corners_{};
  std::uint8_t count_ = 0;
};

/// Equal for equal sets of at most four corners. Larger faces have the key of four of their corners, which no
/// other face of a mesh has.
using FaceKey = std::array<std::uint32_t, 4>;

FaceKey key_of(Corners corners) {
  FaceKey key{};
  if (corners.size() <= most_face_corners) {
    std::array<std::uint32_t, most_face_corners> sorted{};
    const auto end = std::copy(corners.begin(), corners.end(), sorted.begin());
    std::sort(sorted.begin(), end);
    key = {sorted[0], sorted[1], sorted[2], *(end - 1)};
  } else {
    std::partial_sort_copy(corners.begin(), corners.end(), key.begin(), key.end() - 1);
    key[3] = *std::max_element(corners.begin(), corners.end());
  }
  return key;
}

/// Whether the corners are numbered so that the faces of the shape look inwards: more corners lie outside of
/// the planes of its faces than inside.
bool is_inside_out(const SolidShape& shape, Corners solid, const std::vector<Vec3d>& positions) {
  for (const std::uint32_t corner : solid) {
    const Vec3d& p = positions[corner];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  }
  int outside = 0;
  bool used_exact = false;
  for (std::size_t i = 0; i < shape.face_count; ++i) {
    const Loop loop(solid, shape.faces[i]);
    const Corners face = loop.corners();
    if (face.size() < 3) continue;
    for (const std::uint32_t corner : solid) {
      if (std::find(face.begin(), face.end(), corner) != face.end()) continue;
      outside +=
          orient3d(positions[face[0]], positions[face[1]], positions[face[2]], positions[corner], used_exact);
    }
  }
  return outside > 0;
}

/// Whether `polygon`, which has the corners of `face`, goes around them the other way.
bool goes_against(Corners polygon, Corners face) {
  const auto start = std::find(face.begin(), face.end(), polygon[0]) - face.begin();
  const std::size_t before = (static_cast<std::size_t>(start) + face.size() - 1) % face.size();
  return face[before] == polygon[1];
}

/// Who shows a face of a solid.
constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();
constexpr std::size_t itself = nobody - 1;

struct Side {
  FaceKey key;
  std::size_t number;  // polygons first, then the faces of all solids

  auto operator<=>(const Side&) const = default;
};

}  // namespace

std::size_t corner_count(Solid kind) {
  return shape_of(kind).corner_count;
}

void ElementMesh::add_polygon(Corners corners) {
  if (corners.size() < 3) return;
  polygon_corners_.insert(polygon_corners_.end(), corners.begin(), corners.end());
  polygon_ends_.push_back(polygon_corners_.size());
}

void ElementMesh::add_solid(Solid kind, Corners corners) {
  corners = corners.first(corner_count(kind));
  solid_corners_.insert(solid_corners_.end(), corners.begin(), corners.end());
  solids_.push_back(kind);
}

TriangleMesh ElementMesh::take_surface(const std::string& file) {
  const std::size_t polygon_count = polygon_ends_.size();
  const auto polygon = [&](std::size_t i) {
    const std::size_t first = i == 0 ? 0 : polygon_ends_[i - 1];
    return std::span(polygon_corners_).subspan(first, polygon_ends_[i] - first);
  };
  // `visit(shape, corners, face)` for every face of every solid.
  const auto for_each_face = [&](auto&& visit) {
    Corners rest = solid_corners_;
    for (const Solid kind : solids_) {
      const SolidShape& shape = shape_of(kind);
      const Corners corners = rest.first(shape.corner_count);
      for (std::size_t i = 0; i < shape.face_count; ++i) visit(shape, corners, Loop(corners, shape.faces[i]));
      rest = rest.subspan(shape.corner_count);
    }
  };

  std::vector<Side> sides;
  std::size_t face_count = 0;
  if (!solids_.empty()) {
    for (std::size_t i = 0; i < polygon_count; ++i) sides.push_back({key_of(polygon(i)), i});
    for_each_face([&](const SolidShape&, Corners, const Loop& face) {
      if (face.corners().size() >= 3) sides.push_back({key_of(face.corners()), polygon_count + face_count});
      ++face_count;
    });
    std::sort(sides.begin(), sides.end());
  }

  std::vector<std::size_t> shown_by(face_count, nobody);
  std::vector<bool> is_shown(polygon_count, true);
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last =
        std::find_if(first, sides.end(), [&](const Side& side) { return side.key != first->key; });
    const auto face =
        std::find_if(first, last, [&](const Side& side) { return side.number >= polygon_count; });
    const bool is_boundary = last - face == 1;
    if (is_boundary) shown_by[face->number - polygon_count] = face == first ? itself : first->number;
    if (face != last) {
      for (auto side = is_boundary && first != face ? first + 1 : first; side != face; ++side)
        is_shown[side->number] = false;
    }
    first = last;
  }
  sides = {};

  // `visit(number, face)` for every face of the boundary, turned outwards.
  const auto for_each_boundary_face = [&](auto&& visit) {
    std::size_t number = 0;
    for_each_face([&](const SolidShape& shape, Corners solid, Loop face) {
      const std::size_t i = number++;
      if (shown_by[i] == nobody) return;
      if (is_inside_out(shape, solid, positions)) face.turn_around();
      visit(shown_by[i], face.corners());
    });
  };
  for_each_boundary_face([&](std::size_t shower, Corners face) {
    if (shower == itself) return;
    const auto corners = polygon(shower);
    if (goes_against(corners, face)) std::reverse(corners.begin() + 1, corners.end());
  });
  TriangleMesh mesh;
  std::vector<PolygonFan> fans;
  for (std::size_t i = 0; i < polygon_count; ++i) {
    if (is_shown[i]) add_face(mesh, fans, polygon(i));
  }
  for_each_boundary_face([&](std::size_t shower, Corners face) {
    if (shower == itself) add_face(mesh, fans, face);
  });
  mesh.positions = std::move(positions);
  cut_polygons(mesh, fans);
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  if (mesh.positions.size() > most || mesh.triangles.size() > most)
    fail(file + ": more vertices or triangles than the " + std::to_string(most) + " that ids can tell");
  *this = {};
  return mesh;
}

}  // namespace supple
