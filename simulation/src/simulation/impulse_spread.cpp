#include "simulation/impulse_spread.hpp"

#include <algorithm>
#include <cmath>

#include "motion/network/spring_network.hpp"

namespace supple {
namespace {

constexpr std::uint32_t no_place = ~std::uint32_t{0};

struct Link {
  std::uint32_t a, b;
  double stiffness;
};

/// The springs, and for each triangle with area stiffness k, springs of k / √3 on its sides, which are at
/// least as stiff.
std::vector<Link> links_of(const TriangleMesh& rest, const MassSpringOptions& springs) {
  const SpringNetwork network = build_spring_network(rest, springs);
  std::vector<Link> links;
  const auto add = [&](std::uint32_t a, std::uint32_t b, double stiffness) {
    if (stiffness > 0) links.push_back({a, b, stiffness});
  };
  for (const SpringElement& spring : network.edges.elements) add(spring.a, spring.b, springs.stiffness);
  for (const SpringElement& spring : network.bending.elements)
    add(spring.a, spring.b, springs.bending_stiffness);
  for (const AreaElement& area : network.areas.elements) {
    for (int corner = 0; corner < 3; ++corner)
      add(area.corners[corner], area.corners[(corner + 1) % 3], springs.area_stiffness / std::sqrt(3.0));
  }
  return links;
}

double sum_of_products(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

ImpulseSpread::ImpulseSpread(const TriangleMesh& rest, const MassSpringOptions& springs, double seconds)
    : is_fixed_(rest.positions.size(), 0),
      first_(rest.positions.size() + 1, 0),
      shares_(rest.positions.size()),
      place_(rest.positions.size(), no_place) {
  for (const std::uint32_t vertex : springs.fixed_vertices) is_fixed_[vertex] = 1;
  const std::vector<Link> links = links_of(rest, springs);
  for (const Link& link : links) {
    ++first_[link.a + 1];
    ++first_[link.b + 1];
  }
  for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
  neighbors_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  const double scale = seconds * seconds / springs.vertex_mass;
  for (const Link& link : links) {
    neighbors_[next[link.a]++] = {link.b, link.stiffness * scale};
    neighbors_[next[link.b]++] = {link.a, link.stiffness * scale};
  }
}

bool ImpulseSpread::has_springs_of(const ImpulseSpread& other) const {
  return is_fixed_ == other.is_fixed_ && first_ == other.first_ && neighbors_ == other.neighbors_;
}

void ImpulseSpread::begin_step() {
  constexpr std::size_t most_shares = (std::size_t{64} << 20) / sizeof(Share);
  if (share_count_ <= most_shares) return;
  for (std::vector<Share>& shares : shares_) shares = {};
  share_count_ = 0;
}

std::span<const ImpulseSpread::Share> ImpulseSpread::from(std::uint32_t vertex) {
  std::vector<Share>& shares = shares_[vertex];
  if (shares.empty() && is_fixed_[vertex] == 0) {
    gather_patch(vertex);
    solve();
    select_largest_shares();
    shares.assign(largest_.begin(), largest_.end());  // without spare capacity, because it stays
    share_count_ += shares.size();
    for (const std::uint32_t v : patch_) place_[v] = no_place;
  }
  return shares;
}

double ImpulseSpread::share(std::uint32_t vertex, std::uint32_t other) {
  const std::span<const Share> shares = from(vertex);
  const auto found = std::lower_bound(shares.begin(), shares.end(), other,
                                      [](const Share& s, std::uint32_t v) { return s.vertex < v; });
  return found != shares.end() && found->vertex == other ? found->part : 0;
}

/// Breadth-first search from the vertex.
void ImpulseSpread::gather_patch(std::uint32_t vertex) {
  patch_.assign(1, vertex);
  place_[vertex] = 0;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    for (const Neighbor& neighbor : neighbors(patch_[i])) {
      if (patch_.size() == patch_size) return;
      if (place_[neighbor.vertex] != no_place || is_fixed_[neighbor.vertex] != 0) continue;
      place_[neighbor.vertex] = static_cast<std::uint32_t>(patch_.size());
      patch_.push_back(neighbor.vertex);
    }
  }
}

/// Multiplies by 1 + h²/m L. Ignores springs to free vertices outside the patch.
void ImpulseSpread::multiply(std::span<const double> parts, std::span<double> product) const {
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    double sum = parts[i];
    for (const Neighbor& neighbor : neighbors(patch_[i])) {
      if (is_fixed_[neighbor.vertex] != 0) {
        sum += neighbor.stiffness * parts[i];
      } else if (place_[neighbor.vertex] != no_place) {
        sum += neighbor.stiffness * (parts[i] - parts[place_[neighbor.vertex]]);
      }
    }
    product[i] = sum;
  }
}

/// Conjugate gradients, which start with the whole impulse on one vertex. Without fixed vertices each
/// iteration preserves the sum.
void ImpulseSpread::solve() {
  const std::size_t size = patch_.size();
  for (auto* vector : {&parts_, &residual_, &direction_, &product_}) vector->assign(size, 0.0);
  parts_[0] = 1;
  multiply(parts_, product_);
  for (std::size_t i = 0; i < size; ++i) residual_[i] = direction_[i] = parts_[i] - product_[i];
  double squared = sum_of_products(residual_, residual_);
  const double enough = 1e-10 * squared;
  for (std::size_t iteration = 0; iteration < size && squared > enough; ++iteration) {
    multiply(direction_, product_);
    const double step = squared / sum_of_products(direction_, product_);
    for (std::size_t i = 0; i < size; ++i) {
      parts_[i] += step * direction_[i];
      residual_[i] -= step * product_[i];
    }
    const double before = squared;
    squared = sum_of_products(residual_, residual_);
    for (std::size_t i = 0; i < size; ++i) direction_[i] = residual_[i] + squared / before * direction_[i];
  }
}

/// Drops shares below a thousandth of the largest and rescales the rest.
void ImpulseSpread::select_largest_shares() {
  largest_.clear();
  double all = 0, kept = 0;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    all += parts_[i];
    if (!(parts_[i] > 1e-3 * parts_[0])) continue;
    kept += parts_[i];
    largest_.push_back({patch_[i], parts_[i]});
  }
  for (Share& share : largest_) share.part *= all / kept;
  std::sort(largest_.begin(), largest_.end(),
            [](const Share& a, const Share& b) { return a.vertex < b.vertex; });
}

}  // namespace supple
