// Frames of a surgery simulator at 1 kHz: a tool of 980 triangles slides over an organ of 50,000 triangles
// and dents it; 0.9 % of the organ's vertices move. One thread, default options. Prints the median and the
// slowest frames in milliseconds of processor time, and the work of a frame.
//
//   supple_surgery [frames]    default 5000

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace {

using namespace supple;

/// The processor time of this thread: other programs on the machine do not count.
double milliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void measure(const char* name, const DetectRequest& request, int frames) {
  Scene scene({.threads = 1});
  const TriangleMesh tissue = make_icosphere(50);
  TriangleMesh tip = make_icosphere(7);
  for (Vec3d& p : tip.positions) p = 0.15 * p;
  const ObjectId organ = scene.add(tissue, {.name = "organ", .solid = true});
  const ObjectId tool = scene.add(tip, {.name = "tool", .solid = true});
  std::vector<double> times;
  std::vector<std::uint32_t> moved;
  std::vector<Vec3d> positions;
  double contacts = 0, inside = 0, curves = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const double angle = 0.002 * frame, press = 0.05 + 0.03 * std::sin(0.05 * frame);
    const Vec3d way{std::cos(angle), std::sin(angle), 0};
    // Vertices that were pressed before return to their places.
    positions.clear();
    for (const std::uint32_t v : moved) positions.push_back(tissue.positions[v]);
    scene.set_vertices(organ, moved, positions);
    moved.clear();
    positions.clear();
    for (std::uint32_t v = 0; v < tissue.positions.size(); ++v) {
      const Vec3d& p = tissue.positions[v];
      const Vec3d from = p - way;
      const double squared = from.x * from.x + from.y * from.y + from.z * from.z;
      if (squared > 0.036) continue;
      moved.push_back(v);
      positions.push_back(p - (0.5 * press * (1 - squared / 0.036)) * way);
    }
    std::vector<Vec3d> of_tool = tip.positions;
    for (Vec3d& p : of_tool) p += (1.15 - press) * way;
    const double start = milliseconds();
    scene.set_vertices(organ, moved, positions);
    scene.set_positions(tool, of_tool);
    const DetectResult& result = scene.detect(request);
    times.push_back(milliseconds() - start);
    contacts += static_cast<double>(result.contacts.size()) / frames;
    inside += static_cast<double>(result.penetrations.size()) / frames;
    curves += static_cast<double>(result.curves.size()) / frames;
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  std::printf(
      "%-22s p50 %.3f  p99 %.3f  p99.9 %.3f  slowest %.3f ms; a frame has %.1f contacts, %.1f vertices "
      "inside, %.2f curves\n",
      name, at(0.5), at(0.99), at(0.999), times.back(), contacts, inside, curves);
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5000;
  measure("intersections", {.contacts = ContactKinds::intersection}, frames);
  measure("penetration", {.contacts = ContactKinds::penetration}, frames);
  measure("penetration, curves", {.contacts = ContactKinds::penetration, .curves = true}, frames);
}
