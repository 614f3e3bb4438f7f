#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "contest/cells/cells.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple::benchmarks {
namespace {

/// A blade of 980 triangles moves along a spiral over an organ of 50,000 triangles and cuts it: in each
/// frame, the hundred triangles nearest to its tip are replaced by two hundred, with a hundred new vertices.
/// All vertices of the organ move.
class Cutting {
 public:
  Cutting() {
    for (Vec3d& p : blade_.positions) p = 0.08 * p;
    ids_.resize(organ_.triangles.size());
    std::iota(ids_.begin(), ids_.end(), 0u);
  }

  void advance() {
    ++frame_;
    const double height = 0.9 * std::sin(0.003 * frame_), angle = 0.02 * frame_;
    const double radius = std::sqrt(1 - height * height);
    tip_ = {radius * std::cos(angle), radius * std::sin(angle), height};
    of_blade_ = blade_.positions;
    for (Vec3d& p : of_blade_) p += 1.05 * tip_;
    cut();
    positions_ = organ_.positions;
    for (Vec3d& p : positions_) p += (0.01 * std::sin(5 * p.x + 0.1 * frame_)) * p;
  }

  const TriangleMesh& blade() const { return blade_; }
  /// The organ as a mesh of its own, before it moves.
  TriangleMesh organ() const {
    TriangleMesh mesh{.name = "organ", .positions = organ_.positions, .triangles = {}};
    for (const std::uint32_t id : ids_) mesh.triangles.push_back(organ_.triangles[id]);
    return mesh;
  }
  /// The last cut.
  MeshEdit edit() const { return {.removed = removed_, .added = added_, .new_vertices = new_vertices_}; }
  const std::vector<Vec3d>& positions() const { return positions_; }
  const std::vector<Vec3d>& of_blade() const { return of_blade_; }

 private:
  void cut() {
    constexpr std::size_t count = 100;
    const auto squared_distance = [&](std::uint32_t id) {
      const Triangle& t = organ_.triangles[id];
      const Vec3d d =
          (1.0 / 3) * (organ_.positions[t[0]] + organ_.positions[t[1]] + organ_.positions[t[2]]) - tip_;
      return d.x * d.x + d.y * d.y + d.z * d.z;
    };
    std::ranges::nth_element(ids_, ids_.begin() + count, {}, squared_distance);
    removed_.assign(ids_.begin(), ids_.begin() + count);
    ids_.erase(ids_.begin(), ids_.begin() + count);
    added_.clear();
    new_vertices_.clear();
    for (const std::uint32_t id : removed_) {
      const auto [p, q, r] = organ_.triangles[id];
      const auto middle = static_cast<std::uint32_t>(organ_.positions.size() + new_vertices_.size());
      new_vertices_.push_back(0.499 * (organ_.positions[p] + organ_.positions[q]));
      added_.insert(added_.end(), {{p, middle, r}, {middle, q, r}});
    }
    for (std::size_t i = 0; i < added_.size(); ++i)
      ids_.push_back(static_cast<std::uint32_t>(organ_.triangles.size() + i));
    organ_.triangles.insert(organ_.triangles.end(), added_.begin(), added_.end());
    organ_.positions.insert(organ_.positions.end(), new_vertices_.begin(), new_vertices_.end());
  }

  TriangleMesh organ_ = make_icosphere(50), blade_ = make_icosphere(7);
  std::vector<std::uint32_t> ids_;  // of the triangles that are left
  int frame_ = 0;
  Vec3d tip_;
  std::vector<std::uint32_t> removed_;
  std::vector<Triangle> added_;
  std::vector<Vec3d> new_vertices_, positions_, of_blade_;
};

/// The median time in which a scene finds the nearest points of many.
double query_milliseconds(const Scene& scene, ObjectId organ) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 20'000; ++i)
    points.push_back({std::sin(0.7 * i), std::sin(1.3 * i + 1), std::sin(1.9 * i + 2)});
  std::vector<std::optional<ClosestPoint>> found(points.size());
  std::vector<double> times;
  for (int run = 0; run < 5; ++run) {
    const double start = cpu_milliseconds();
    scene.closest(points, found, {.filter = {.object = organ}});
    times.push_back(cpu_milliseconds() - start);
  }
  return quantile(times, 0.5);
}

void put_times(Output& output, const std::string& name, const std::vector<double>& times) {
  output.value("milliseconds, median of " + name, quantile(times, 0.5));
  output.value("milliseconds, 99th percentile of " + name, quantile(times, 0.99));
}

}  // namespace

void run_cutting(const Choice& choice, Output& output) {
  const std::size_t frames = choice.rounds == Choice().rounds ? 1'000 : choice.rounds;
  const SceneOptions options{.threads = 1};
  std::vector<double> edits, edited_frames, added_again;
  Scene edited(options), replaced(options);
  Cutting cutting;
  const ObjectId organ = edited.add(cutting.organ()), blade = edited.add(cutting.blade());
  ObjectId old = replaced.add(cutting.organ());
  const ObjectId other_blade = replaced.add(cutting.blade());
  edited.detect();
  replaced.detect();
  double contacts = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    cutting.advance();
    double start = cpu_milliseconds();
    edited.edit(organ, cutting.edit());
    edits.push_back(cpu_milliseconds() - start);
    edited.set_positions(organ, cutting.positions());
    edited.set_positions(blade, cutting.of_blade());
    contacts += static_cast<double>(edited.detect().contacts.size());
    edited_frames.push_back(cpu_milliseconds() - start);
    if (frame % 10 != 0) continue;
    TriangleMesh mesh = cutting.organ();
    mesh.positions = cutting.positions();
    start = cpu_milliseconds();
    replaced.remove(old);
    old = replaced.add(mesh);
    replaced.set_positions(other_blade, cutting.of_blade());
    replaced.detect();
    added_again.push_back(cpu_milliseconds() - start);
    if (replaced.result().contacts.size() != edited.result().contacts.size())
      throw Disagreement("an edited object has other contacts than one that was added again");
  }
  output.value("frames", static_cast<double>(frames));
  output.value("contacts a frame", contacts / static_cast<double>(frames));
  put_times(output, "an edit", edits);
  put_times(output, "a frame with an edit", edited_frames);
  put_times(output, "a frame with remove and add", added_again);
  TriangleMesh mesh = cutting.organ();
  mesh.positions = cutting.positions();
  Scene fresh(options);
  const ObjectId added = fresh.add(mesh);
  output.value("milliseconds of queries, edited", query_milliseconds(edited, organ));
  output.value("milliseconds of queries, fresh", query_milliseconds(fresh, added));
}

}  // namespace supple::benchmarks
