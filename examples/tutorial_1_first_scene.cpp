// Tutorial, part 1: two models that intersect.
#include <cstdio>

#include "supple/models.hpp"
#include "supple/supple.hpp"
#include "supple/verify.hpp"

int main() {
  supple::Scene scene;
  scene.add(supple::make_model("rabbit"), {.name = "rabbit"});
  const supple::ObjectId fish = scene.add(supple::make_model("fish"), {.name = "fish"});
  scene.set_transform(fish, {.translation = {0.5, 0.1, 0}});

  const supple::DetectResult& result = scene.detect();
  for (const supple::ContactGroup& group : result.groups) {
    std::printf("%s and %s: %u contacts\n", scene.options(group.a).name.c_str(),
                scene.options(group.b).name.c_str(), group.contact_count);
  }
  const supple::Contact& first = result.contacts.front();
  for (const supple::ContactPoint& point : result.points_of(first)) {
    std::printf("  triangles %u and %u share (%.3f, %.3f, %.3f)\n", first.triangle_a, first.triangle_b,
                point.position.x, point.position.y, point.position.z);
  }
  std::printf("%s\n", verify(scene).agrees() ? "brute force agrees" : "brute force disagrees");
}
