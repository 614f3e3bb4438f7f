#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "contest/cells/cells.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple::benchmarks {
namespace {

/// A tool of 980 triangles slides over an organ of 50,000 triangles and dents it: 0.9 % of the organ's
/// vertices move in a frame, and those that the tool has left return to their places.
class Surgery {
 public:
  Surgery() {
    for (Vec3d& p : tool_.positions) p = 0.15 * p;
  }
  void add_to(Scene& scene) {
    in_scene_ = {scene.add(organ_, {.name = "organ", .solid = true}),
                 scene.add(tool_, {.name = "tool", .solid = true})};
  }
  void advance() {
    const double angle = 0.002 * frame_, press = 0.05 + 0.03 * std::sin(0.05 * frame_);
    ++frame_;
    const Vec3d way{std::cos(angle), std::sin(angle), 0};
    returning_ = moved_;
    returned_.clear();
    for (const std::uint32_t v : moved_) returned_.push_back(organ_.positions[v]);
    moved_.clear();
    positions_.clear();
    constexpr double squared_radius = 0.036;
    for (std::uint32_t v = 0; v < organ_.positions.size(); ++v) {
      const Vec3d& p = organ_.positions[v];
      const Vec3d from = p - way;
      const double squared = from.x * from.x + from.y * from.y + from.z * from.z;
      if (squared > squared_radius) continue;
      moved_.push_back(v);
      positions_.push_back(p - (0.5 * press * (1 - squared / squared_radius)) * way);
    }
    of_tool_ = tool_.positions;
    for (Vec3d& p : of_tool_) p += (1.15 - press) * way;
  }
  void set_positions(Scene& scene) const {
    scene.set_vertices(in_scene_[0], returning_, returned_);
    scene.set_vertices(in_scene_[0], moved_, positions_);
    scene.set_positions(in_scene_[1], of_tool_);
  }

 private:
  TriangleMesh organ_ = make_icosphere(50), tool_ = make_icosphere(7);
  std::array<ObjectId, 2> in_scene_;
  int frame_ = 0;
  std::vector<std::uint32_t> returning_, moved_;
  std::vector<Vec3d> returned_, positions_, of_tool_;
};

}  // namespace

void run_surgery(const Choice& choice, Output& output) {
  const std::size_t frames = choice.rounds == Choice().rounds ? 5'000 : choice.rounds;
  // The frames of all runs are the same. The least time of each one is without the delays that other programs
  // on the machine cause, which would be the slowest frames.
  constexpr int runs = 4;
  output.value("frames", static_cast<double>(frames));
  for (const bool with_curves : {false, true}) {
    std::vector<double> times(frames, std::numeric_limits<double>::infinity());
    double contacts = 0;
    for (int run = 0; run < runs; ++run) {
      Scene scene({.contacts = ContactKinds::penetration, .curves = with_curves, .threads = 1});
      Surgery surgery;
      surgery.add_to(scene);
      scene.detect();
      for (double& time : times) {
        surgery.advance();
        const double start = cpu_milliseconds();
        surgery.set_positions(scene);
        contacts += static_cast<double>(scene.detect().contacts.size());
        time = std::min(time, cpu_milliseconds() - start);
      }
    }
    const std::string with = with_curves ? ", with curves" : "";
    output.value("milliseconds, median" + with, quantile(times, 0.5));
    output.value("milliseconds, 99th percentile" + with, quantile(times, 0.99));
    output.value("milliseconds, 99.9th percentile" + with, quantile(times, 0.999));
    output.value("contacts a frame" + with, contacts / (runs * static_cast<double>(frames)));
  }
}

}  // namespace supple::benchmarks
