#include "world/object/orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "contact/distance/upward_ray.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/vector.hpp"
#include "mesh/vertex_sets.hpp"

namespace supple {
namespace {

TrianglePoints corners_of(const Triangle& triangle, const PositionsView& positions) {
  return {positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]};
}

/// The sign of the volume that triangles enclose; 2 when a vertex is not finite. `for_each(visit)` calls
/// `visit` with the corners of each triangle. The filter takes `origin` as the origin.
template <class ForEach>
int sign_of_volume(const Vec3d& origin, const ForEach& for_each) {
  double volume = 0, products = 0, largest = 0, count = 0;
  for_each([&](const TrianglePoints& p) {
    const Vec3d u = p[0] - origin, v = p[1] - origin, w = p[2] - origin;
    volume += dot(cross(u, v), w);
    const Vec3d a = absolute(u), b = absolute(v), c = absolute(w);
    products += (a.y * b.z + a.z * b.y) * c.x + (a.z * b.x + a.x * b.z) * c.y + (a.x * b.y + a.y * b.x) * c.z;
    largest = std::max({largest, largest_magnitude(u), largest_magnitude(v), largest_magnitude(w)});
    ++count;
  });
  // Each term has less than 12 roundings, and each sum one for each term. Terms that vanish in the range of
  // doubles are below 2^-1074 · 2^300 each.
  const double bound = (count + 16) * 0x1p-52 * products;
  if (largest < 0x1p300 && products > 0x1p-600 && std::fabs(volume) > bound) return volume > 0 ? 1 : -1;

  BitExtent extent;
  bool is_finite_sheet = true;
  for_each([&](const TrianglePoints& p) {
    for (const Vec3d& corner : p) {
      is_finite_sheet = is_finite_sheet && is_finite(corner);
      for (int axis = 0; is_finite_sheet && axis < 3; ++axis) extent.include(corner[axis]);
    }
  });
  if (!is_finite_sheet) return 2;
  UnboundedInteger sum = 0;
  for_each([&](const TrianglePoints& p) {
    std::array<Vector3<UnboundedInteger>, 3> integers;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        integers[i][axis] = to_integer<UnboundedInteger>(p[i][static_cast<int>(axis)], extent.bottom);
    }
    sum += determinant(integers[0], integers[1], integers[2]);
  });
  return sign(sum);
}

/// The lowest and the highest vertex along each axis.
struct Extremes {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<Vec3d, 3> lowest{Vec3d{infinity, 0, 0}, Vec3d{0, infinity, 0}, Vec3d{0, 0, infinity}};
  std::array<Vec3d, 3> highest{Vec3d{-infinity, 0, 0}, Vec3d{0, -infinity, 0}, Vec3d{0, 0, -infinity}};

  void include(const Vec3d& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      if (p[axis] < lowest[i][axis]) lowest[i] = p;
      if (p[axis] > highest[i][axis]) highest[i] = p;
    }
  }
  /// Whether the box of the other one is inside the box, without touching its sides.
  bool surrounds(const Extremes& other) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      if (!(lowest[i][axis] < other.lowest[i][axis] && other.highest[i][axis] < highest[i][axis]))
        return false;
    }
    return true;
  }
};

}  // namespace

Orientation::Orientation(std::vector<Triangle> triangles, const PositionsView& positions)
    : triangles_(std::move(triangles)), inward_(triangles_.size()) {
  list_sheets();
  if (sheets_.size() > 1) find_holes(positions);
  judge(positions);
}

/// Edges of two triangles connect them. Where more meet, only those are connected that are not closed without
/// each other.
void Orientation::list_sheets() {
  struct Use {
    std::uint32_t first, last, triangle;
    int direction;
  };
  const auto count = static_cast<std::uint32_t>(triangles_.size());
  std::vector<Use> uses;
  uses.reserve(3 * triangles_.size());
  for (std::uint32_t t = 0; t < count; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles_[t][i], to = triangles_[t][(i + 1) % 3];
      if (from != to) uses.push_back({std::min(from, to), std::max(from, to), t, from < to ? 1 : -1});
    }
  }
  const auto edge_of = [](const Use& use) { return std::pair(use.first, use.last); };
  std::ranges::sort(uses, {}, edge_of);
  VertexSets sheets(count);
  std::vector<std::pair<std::uint32_t, int>> meeting;  // sheets at an edge, and directions
  for (const std::size_t pass : {0, 1}) {
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
      while (end < uses.size() && edge_of(uses[end]) == edge_of(uses[begin])) ++end;
      if ((end - begin == 2) != (pass == 0)) continue;
      meeting.clear();
      for (std::size_t i = begin; i < end; ++i)
        meeting.emplace_back(sheets.root(uses[i].triangle), uses[i].direction);
      std::ranges::sort(meeting);
      std::uint32_t open = count;
      for (std::size_t i = 0; i < meeting.size();) {
        const std::uint32_t sheet = meeting[i].first;
        int sum = 0;
        for (; i < meeting.size() && meeting[i].first == sheet; ++i) sum += meeting[i].second;
        if (sum != 0) open = sheets.join(open == count ? sheet : open, sheet);
      }
    }
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::stable_sort(order_, {}, [&](std::uint32_t t) { return sheets.root(t); });
  for (std::uint32_t i = 0; i < count; ++i) {
    if (sheets.root(order_[i]) == order_[i]) sheets_.push_back({i, i});
    ++sheets_.back().last;
  }
}

void Orientation::find_holes(const PositionsView& positions) {
  std::vector<Extremes> extremes(sheets_.size());
  std::vector<std::uint32_t> by_x, reached;  // sheets, and those that may reach to the present one
  for (std::uint32_t s = 0; s < sheets_.size(); ++s) {
    bool is_finite_sheet = true;
    for (const std::uint32_t t : triangles_of(sheets_[s])) {
      for (const Vec3d& p : corners_of(triangles_[t], positions)) {
        extremes[s].include(p);
        is_finite_sheet = is_finite_sheet && is_finite(p);
      }
    }
    if (is_finite_sheet) by_x.push_back(s);
  }
  const auto lowest_x = [&](std::uint32_t s) { return extremes[s].lowest[0].x; };
  const auto is_inside = [&](const Vec3d& p, const Sheet& sheet) {
    UpwardRay ray(p);
    for (const std::uint32_t t : triangles_of(sheet)) ray.meet(corners_of(triangles_[t], positions));
    return !ray.starts_on_surface() && ray.is_odd();
  };
  std::ranges::sort(by_x, {}, lowest_x);
  for (const std::uint32_t s : by_x) {
    std::erase_if(reached, [&](std::uint32_t outer) { return extremes[outer].highest[0].x < lowest_x(s); });
    for (const std::uint32_t outer : reached) {
      if (!extremes[outer].surrounds(extremes[s])) continue;
      const auto is_inside_outer = [&](const Vec3d& p) { return is_inside(p, sheets_[outer]); };
      if (std::ranges::all_of(extremes[s].lowest, is_inside_outer) &&
          std::ranges::all_of(extremes[s].highest, is_inside_outer))
        sheets_[s].is_hole = !sheets_[s].is_hole;
    }
    reached.push_back(s);
  }
}

void Orientation::judge(const PositionsView& positions) {
  has_inward_ = false;
  is_flat_ = !sheets_.empty();
  for (const Sheet& sheet : sheets_) {
    const std::span<const std::uint32_t> triangles = triangles_of(sheet);
    const Vec3d origin = positions[triangles_[triangles.front()][0]];
    const int sign = sign_of_volume(origin, [&](const auto& visit) {
      for (const std::uint32_t t : triangles) visit(corners_of(triangles_[t], positions));
    });
    is_flat_ = is_flat_ && sign == 0;
    const bool is_inward = sign == (sheet.is_hole ? 1 : -1);
    has_inward_ = has_inward_ || is_inward;
    for (const std::uint32_t t : triangles) inward_[t] = is_inward ? 1 : 0;
  }
}

}  // namespace supple
