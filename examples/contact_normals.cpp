// A simple response: two spheres that overlap move apart along the mean normal of their contacts until they
// no longer touch.
#include <cstdio>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  const supple::TriangleMesh sphere = supple::make_icosphere(8);
  supple::Scene scene;
  const supple::ObjectId left = scene.add(sphere, {.name = "left"});
  const supple::ObjectId right = scene.add(sphere, {.name = "right"});
  scene.translate(right, {1.95, 0.1, 0.05});

  for (int round = 0; round < 100; ++round) {
    const supple::DetectResult& result = scene.detect();
    std::printf("round %d: %zu contacts\n", round, result.contacts.size());
    if (result.contacts.empty()) break;
    supple::Vec3d sum{};
    for (const supple::Contact& c : result.contacts) sum += c.normal;
    const supple::Vec3d normal = sum / norm(sum);
    scene.translate(left, 0.005 * normal);
    scene.translate(right, -0.005 * normal);
  }
}
