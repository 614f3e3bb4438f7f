// Events: two spheres pass through each other. The program reacts only when they begin or stop touching.
#include <cstdio>
#include <string>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  supple::Scene scene;
  supple::TriangleMesh ball = supple::make_icosphere(8);
  ball.name = "still";
  scene.add(ball, {.is_static = true});
  ball.name = "passing";
  const supple::ObjectId passing = scene.add(ball);

  for (int frame = 0; frame <= 12; ++frame) {
    // Moving an object without deforming it is O(1): no vertex is read.
    scene.set_transform(passing, {.translation = {-3.0 + 0.5 * frame, 0.25, 0.125}});
    const supple::PairEvents& events = scene.detect().contact_events;
    for (const supple::ObjectPair& pair : events.begin)
      std::printf("frame %d: %s and %s begin to touch\n", frame, scene.options(pair.a).name.c_str(),
                  scene.options(pair.b).name.c_str());
    for (const supple::ObjectPair& pair : events.end)
      std::printf("frame %d: %s and %s part\n", frame, scene.options(pair.a).name.c_str(),
                  scene.options(pair.b).name.c_str());
  }
}
