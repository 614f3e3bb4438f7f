// A simple response: each contact pushes the vertices of its two triangles apart along the contact normal,
// until two soft spheres that overlap no longer touch.
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  const supple::TriangleMesh sphere = supple::make_icosphere(8);
  std::vector<supple::Vec3d> left = sphere.positions, right = sphere.positions;
  for (supple::Vec3d& p : right) p += supple::Vec3d{1.95, 0.1, 0.05};

  supple::Scene scene;
  const supple::ObjectId a = scene.add(left, sphere.triangles, {.name = "left"});
  const supple::ObjectId b = scene.add(right, sphere.triangles, {.name = "right"});

  for (int round = 0; round < 100; ++round) {
    scene.share_positions(a, left);
    scene.share_positions(b, right);
    const supple::DetectResult& result = scene.detect();
    if (round % 10 == 0 || result.contacts.empty())
      std::printf("round %d: %zu contacts\n", round, result.contacts.size());
    if (result.contacts.empty()) break;
    for (const supple::Contact& c : result.contacts) {
      for (const std::uint32_t v : scene.vertices_of(c, supple::ContactSide::a)) left[v] += 1e-3 * c.normal;
      for (const std::uint32_t v : scene.vertices_of(c, supple::ContactSide::b)) right[v] -= 1e-3 * c.normal;
    }
  }
}
