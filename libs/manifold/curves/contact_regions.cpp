#include "manifold/curves/contact_regions.hpp"

#include <algorithm>
#include <tuple>

#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

constexpr std::uint8_t is_corner = 1, is_on_other = 2;

}  // namespace

void ContactRegions::start(const SurfaceView& surface) {
  surface_ = surface;
  const std::size_t vertices = surface.around->vertex_count();
  for (const std::uint32_t v : marked_) marks_[v] = 0;
  marked_.clear();
  marks_.resize(std::max(marks_.size(), vertices), 0);
  state_.resize(std::max(state_.size(), vertices), 0);
  crossings_.clear();
}

void ContactRegions::add(const Point& point) {
  const FeatureName& feature = point.feature;
  // In this order, `start` finds all marks also after memory ran out.
  marked_.insert(marked_.end(), point.triangle.begin(), point.triangle.end());
  for (const std::uint32_t v : point.triangle) marks_[v] |= is_corner;
  if (feature.kind == FeatureKind::edge) {
    add_crossing(point, feature.first, feature.last);
    add_crossing(point, feature.last, feature.first);
  }
  if (feature.kind != FeatureKind::vertex) return;
  marks_[feature.first] |= is_on_other;
  for (const std::uint32_t v : point.triangle) {
    if (v != feature.first) add_crossing(point, v, feature.first);
  }
}

void ContactRegions::add_crossing(const Point& point, std::uint32_t corner, std::uint32_t other) {
  const Vec3d p = surface_.position(corner);
  bool used_exact = false;
  const int side = orient3d(point.other[0], point.other[1], point.other[2], p, used_exact);
  const std::uint8_t sides = side > 0 ? in_front : side < 0 ? behind : in_plane;
  crossings_.push_back(
      {corner, other, largest_magnitude(point.position - p), point.key, point.curve, sides, point.position});
}

void ContactRegions::link(std::uint32_t curve_count) {
  // A point lies on several triangles of the other surface.
  std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& p, const Crossing& q) {
    return std::tie(p.corner, p.other, p.key, p.distance) < std::tie(q.corner, q.other, q.key, q.distance);
  });
  std::size_t count = 0;
  for (const Crossing& crossing : crossings_) {
    Crossing* const last = count > 0 ? &crossings_[count - 1] : nullptr;
    if (last != nullptr && std::tie(last->corner, last->other, last->key) ==
                               std::tie(crossing.corner, crossing.other, crossing.key))
      last->sides |= crossing.sides;
    else
      crossings_[count++] = crossing;
  }
  crossings_.resize(count);
  std::sort(crossings_.begin(), crossings_.end(),
            [](const Crossing& p, const Crossing& q) { return p.order() < q.order(); });
  seeds_.clear();
  all_middles_.clear();
  for (std::size_t first = 0, next = 0; first < count; first = next) {
    while (next < count && std::tie(crossings_[next].corner, crossings_[next].other) ==
                               std::tie(crossings_[first].corner, crossings_[first].other))
      ++next;
    list_seeds(std::span(crossings_).subspan(first, next - first));
  }
  std::sort(seeds_.begin(), seeds_.end());
  std::sort(all_middles_.begin(), all_middles_.end(), [](const Middle& p, const Middle& q) {
    return p.curve != q.curve ? p.curve < q.curve : lexicographically_less(p.position, q.position);
  });
  const auto list_first = [&](const auto& list, std::vector<std::uint32_t>& first_of) {
    first_of.assign(curve_count + 1, 0);
    for (const auto& item : list) ++first_of[item.curve + 1];
    for (std::uint32_t c = 0; c < curve_count; ++c) first_of[c + 1] += first_of[c];
  };
  list_first(seeds_, first_seed_);
  list_first(all_middles_, first_middle_);
}

/// Lists what the points on an edge tell of its first corner, and where the edge is behind the other surface
/// between two of them.
void ContactRegions::list_seeds(std::span<const Crossing> edge) {
  const auto add = [&](const Crossing& crossing, std::uint8_t sides, bool is_nearest) {
    if (sides == behind)
      seeds_.push_back({crossing.curve, is_nearest ? Place::inside : Place::beyond, crossing.corner});
    else if (sides == in_front && is_nearest)
      seeds_.push_back({crossing.curve, Place::front, crossing.corner});
  };
  // Points at the same place tell it together.
  std::size_t nearest = 0;
  std::uint8_t sides = 0;
  for (; nearest < edge.size() && edge[nearest].distance == edge[0].distance; ++nearest)
    sides |= edge[nearest].sides;
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const bool is_nearest = i < nearest;
    add(edge[i], is_nearest ? sides : edge[i].sides, is_nearest);
    if (i == 0 || edge[0].corner > edge[0].other || edge[i - 1].sides != in_front) continue;
    const Vec3d middle = 0.5 * edge[i - 1].position + 0.5 * edge[i].position;
    all_middles_.push_back({edge[i].curve, middle});
    if (edge[i - 1].curve != edge[i].curve) all_middles_.push_back({edge[i - 1].curve, middle});
  }
}

std::span<const ContactRegions::Crossing> ContactRegions::crossings_of(std::uint32_t corner,
                                                                       std::uint32_t other) const {
  const auto [first, last] =
      std::equal_range(crossings_.begin(), crossings_.end(), Crossing{corner, other, 0, 0, 0, 0, {}},
                       [](const Crossing& p, const Crossing& q) {
                         return std::tie(p.corner, p.other) < std::tie(q.corner, q.other);
                       });
  return {first, last};
}

bool ContactRegions::is_cut(std::uint32_t v, std::uint32_t w) const {
  return (marks_[v] & marks_[w] & is_corner) != 0 && !crossings_of(v, w).empty();
}

bool ContactRegions::is_cut_by(std::uint32_t curve, std::uint32_t v, std::uint32_t w) const {
  if ((marks_[v] & marks_[w] & is_corner) == 0) return false;
  const auto crossings = crossings_of(v, w);
  return std::any_of(crossings.begin(), crossings.end(),
                     [&](const Crossing& crossing) { return crossing.curve == curve; });
}

/// Whether the vertex can belong to the region and was not reached before.
bool ContactRegions::is_open(std::uint32_t vertex) const {
  return state_[vertex] < stamp_ - 1 && (marks_[vertex] & is_on_other) == 0;
}

bool ContactRegions::reach(std::uint32_t vertex) {
  if (!is_open(vertex)) return false;
  state_[vertex] = stamp_;
  return true;
}

template <class IsCut>
void ContactRegions::add_neighbours(std::uint32_t v, const IsCut& is_cut, std::vector<std::uint32_t>& list) {
  for (const std::uint32_t t : surface_.around->around(v)) {
    for (const std::uint32_t w : surface_.triangle(t)) {
      if (is_open(w) && !is_cut(v, w) && reach(w)) list.push_back(w);
    }
  }
}

void ContactRegions::begin(std::uint32_t curve) {
  stamp_ += 2;
  inside_.clear();
  beyond_.clear();
  middles_.clear();
  for (const Seed& seed : seeds_of(curve)) {
    if (seed.place == Place::inside && reach(seed.vertex)) inside_.push_back(seed.vertex);
    if (seed.place == Place::front && state_[seed.vertex] != stamp_) state_[seed.vertex] = stamp_ - 1;
  }
}

void ContactRegions::decide(std::uint32_t vertex, bool is_inside) {
  if (is_inside) inside_.push_back(vertex);
  state_[vertex] = is_inside ? stamp_ : stamp_ - 1;
}

void ContactRegions::grow(std::uint32_t curve, std::size_t most) {
  for (std::size_t next = 0; next < inside_.size() && inside_.size() < most; ++next)
    add_neighbours(
        inside_[next], [&](std::uint32_t v, std::uint32_t w) { return is_cut(v, w); }, inside_);

  const std::size_t most_beyond = 64 + 16 * (first_seed_[curve + 1] - first_seed_[curve]);
  const auto is_cut_here = [&](std::uint32_t v, std::uint32_t w) { return is_cut_by(curve, v, w); };
  for (const Seed& seed : seeds_of(curve)) {
    if (seed.place == Place::beyond && reach(seed.vertex)) beyond_.push_back(seed.vertex);
  }
  for (const std::uint32_t v : inside_) {
    if ((marks_[v] & is_corner) != 0) add_neighbours(v, is_cut_here, beyond_);
  }
  for (std::size_t next = 0; next < beyond_.size() && beyond_.size() <= most_beyond; ++next)
    add_neighbours(beyond_[next], is_cut_here, beyond_);
  if (beyond_.size() > most_beyond) beyond_.clear();

  for (std::uint32_t i = first_middle_[curve]; i < first_middle_[curve + 1]; ++i)
    middles_.push_back(all_middles_[i].position);
}

}  // namespace supple
