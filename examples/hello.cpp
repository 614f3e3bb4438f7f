#include <cstdio>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  supple::TriangleMesh mesh = supple::make_model("fish");
  supple::Scene scene;
  scene.add(supple::make_model("rabbit"), {.is_static = true});
  const supple::ObjectId fish = scene.add(mesh);

  for (int frame = 0; frame < 5; ++frame) {
    for (supple::Vec3d& p : mesh.positions) p += {0.2, 0, 0.1 * p.x * p.x};  // your simulation goes here
    scene.set_positions(fish, mesh.positions);
    std::printf("frame %d: %zu contacts\n", frame, scene.detect().contacts.size());
  }
}
