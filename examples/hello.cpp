#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  const supple::TriangleMesh fish_mesh = supple::make_model("fish");

  supple::Scene scene;
  scene.add(supple::make_model("rabbit"), {.is_static = true});
  const supple::ObjectId fish = scene.add(fish_mesh);

  for (int frame = 0; frame < 5; ++frame) {
    // Your own simulation goes here. This one moves the fish closer and bends it.
    std::vector<supple::Vec3d> positions = fish_mesh.positions;
    for (supple::Vec3d& p : positions) {
      p.z += 0.1 * frame * p.x * p.x;
      p.x += 1.0 - 0.25 * frame;
    }
    scene.set_positions(fish, positions);

    const supple::DetectResult& result = scene.detect();
    std::printf("frame %d: %zu contacts\n", frame, result.contacts.size());
    if (result.contacts.empty()) continue;

    const supple::Contact& c = result.contacts.front();
    const supple::Vec3d p = result.points_of(c).front().position;
    std::printf("  the first: triangle %u of %s meets triangle %u of %s at (%.3f, %.3f, %.3f)\n",
                c.triangle_a, scene.name(c.object_a).c_str(), c.triangle_b, scene.name(c.object_b).c_str(),
                p.x, p.y, p.z);
  }
}
