#include <cstdio>

#include "supple/comparison.hpp"
#include "supple/inspection.hpp"
#include "supple/mesh_file.hpp"
#include "supple/recording.hpp"
#include "supple/supple.hpp"
#include "supple/use_manifolds.hpp"
#include "supple/verify.hpp"

int main() {
  supple::Recorder recorder("consumer.h5", {});
  recorder.add(0.5, {}, {});
  recorder.close();
  const supple::Recording recording("consumer.h5");

  supple::save_mesh({"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "triangle.obj");
  supple::use_comparison_methods();
  supple::use_manifolds();
  supple::Scene scene({.bounding_volume = supple::BoundingVolume::obb});
  scene.add(supple::load_mesh("triangle.obj"));
  scene.add(supple::load_mesh("triangle.obj"));
  scene.detect();
  if (!supple::verify(scene).agrees() || !supple::SceneInspector(scene).validate().empty()) return 1;
  std::printf("supple %s: frame at %g s\n", SUPPLE_VERSION, recording.frame(0).time);
}
