// Where only a part of an object moves, `set_vertices` updates only that part of its octree.
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  supple::Scene scene;
  const supple::TriangleMesh tissue = supple::make_icosphere(60);
  const supple::ObjectId organ = scene.add(tissue, {.name = "organ"});
  const supple::ObjectId tool = scene.add(supple::make_box({0.1, 0.1, 1}, 4), {.name = "tool"});
  scene.translate(tool, {0, 0, 1.5});
  scene.detect();

  // The tool presses into the top, and only vertices near it give way.
  for (int step = 1; step <= 5; ++step) {
    const double depth = 0.02 * step;
    std::vector<std::uint32_t> pressed;
    std::vector<supple::Vec3d> positions;
    for (std::uint32_t v = 0; v < tissue.positions.size(); ++v) {
      const supple::Vec3d& p = tissue.positions[v];
      const double squared_distance = p.x * p.x + p.y * p.y;
      if (p.z < 0 || squared_distance > 0.04) continue;
      pressed.push_back(v);
      positions.push_back({p.x, p.y, p.z - depth * (1 - squared_distance / 0.04)});
    }
    scene.set_vertices(organ, pressed, positions);
    scene.translate(tool, {0, 0, -0.025});
    const supple::DetectResult& result = scene.detect();
    std::printf("depth %.2f: %zu of %zu vertices moved, %llu of %zu triangles refitted, %zu contacts\n",
                depth, pressed.size(), tissue.positions.size(),
                static_cast<unsigned long long>(result.stats.triangles_refitted), tissue.triangles.size(),
                result.contacts.size());
  }
}
