// A cloth falls so fast that it would pass through a ball within one step. Each step stops short of the
// first contact.
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  const supple::TriangleMesh cloth_mesh = supple::make_cloth(40, 40);

  supple::SceneOptions options;
  options.contacts = supple::ContactKinds::continuous;
  options.impact.min_separation = 1e-3;  // the thickness of the cloth
  supple::Scene scene(options);
  scene.add(supple::make_icosphere(12), {.name = "ball", .is_static = true});
  const supple::ObjectId cloth = scene.add(cloth_mesh, {.name = "cloth", .self_collision = true});

  std::vector<supple::Vec3d> now = cloth_mesh.positions;
  for (supple::Vec3d& p : now) p.y += 3;
  const supple::Vec3d velocity{0, -4, 0};  // per step
  for (int step = 0; step < 2; ++step) {
    std::vector<supple::Vec3d> next = now;
    for (supple::Vec3d& p : next) p = p + velocity;
    scene.set_motion(cloth, now, next);

    const auto impact = scene.earliest_impact();
    if (!impact) {
      std::printf("step %d: nothing in the way\n", step);
      now = next;
      continue;
    }
    std::printf("step %d: %s and %s touch at %.6f, and %zu pairs would by the end\n", step,
                scene.options(impact->object_a).name.c_str(), scene.options(impact->object_b).name.c_str(),
                impact->toi, scene.detect().continuous_contacts.size());
    // Your own response goes here. This one stops before the contact.
    const double part = 0.9 * scene.max_step().step;
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = now[i] + part * velocity;
  }
}
