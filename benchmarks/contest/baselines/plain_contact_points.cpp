#include <array>
#include <cmath>
#include <utility>

#include "contest/baselines/triangle_test.hpp"

namespace supple::benchmarks {
namespace {

using Corners = std::array<Vec3d, 3>;

Vec3d cross(const Vec3d& u, const Vec3d& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}
double dot(const Vec3d& u, const Vec3d& v) {
  return u.x * v.x + u.y * v.y + u.z * v.z;
}

struct PlainContact {
  CopyPair pair;
  Vec3d normal;
  std::array<Vec3d, 2> points;
  int point_count = 0;
};

/// Adds the points in which edges of `p` pierce the triangle `q` with the normal `n`.
void add_points(const Corners& p, const Corners& q, const Vec3d& n, PlainContact& contact) {
  std::array<double, 3> height{};
  for (std::size_t i = 0; i < 3; ++i) height[i] = dot(n, p[i] - q[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (contact.point_count == 2 || (height[i] > 0) == (height[j] > 0)) continue;
    const Vec3d x = p[i] + (p[j] - p[i]) * (height[i] / (height[i] - height[j]));
    bool is_inside = true;
    for (std::size_t k = 0; k < 3 && is_inside; ++k)
      is_inside = dot(n, cross(q[(k + 1) % 3] - q[k], x - q[k])) >= 0;
    if (is_inside) contact.points[static_cast<std::size_t>(contact.point_count++)] = x;
  }
}

class WithContactPoints : public CopiesContestant {
 public:
  explicit WithContactPoints(std::unique_ptr<CandidateContestant> finder) : finder_(std::move(finder)) {}

  void prepare(const DeformingCopies& copies) override { finder_->prepare(copies); }
  void frame(const DeformingCopies& copies) override {
    finder_->frame(copies);
    const double start = cpu_milliseconds();
    contacts_.clear();
    for (const CopyPair& pair : finder_->intersecting()) {
      const Corners a = corners(copies, pair.object_a, pair.triangle_a);
      const Corners b = corners(copies, pair.object_b, pair.triangle_b);
      const Vec3d normal_a = cross(a[1] - a[0], a[2] - a[0]), normal_b = cross(b[1] - b[0], b[2] - b[0]);
      PlainContact contact{pair, normal_b * (1 / std::sqrt(dot(normal_b, normal_b))), {}, 0};
      add_points(a, b, normal_b, contact);
      add_points(b, a, normal_a, contact);
      contacts_.push_back(contact);
    }
    stages_ = finder_->stages();
    stages_.push_back({"contact points", cpu_milliseconds() - start});
  }
  PairDigest pairs() const override { return finder_->pairs(); }
  std::vector<StageTime> stages() const override { return stages_; }

 private:
  static Corners corners(const DeformingCopies& copies, std::uint32_t object, std::uint32_t triangle) {
    const Triangle& t = copies.triangles()[triangle];
    Corners result;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3f& p = copies.positions(object)[t[i]];
      result[i] = {p.x, p.y, p.z};
    }
    return result;
  }

  std::unique_ptr<CandidateContestant> finder_;
  std::vector<PlainContact> contacts_;
  std::vector<StageTime> stages_;
};

}  // namespace

std::unique_ptr<CopiesContestant> with_contact_points(std::unique_ptr<CandidateContestant> finder) {
  return std::make_unique<WithContactPoints>(std::move(finder));
}

}  // namespace supple::benchmarks
