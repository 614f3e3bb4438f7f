// Which objects may touch: groups and masks decide cheaply, a function decides the rest.
#include <cstdio>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  constexpr std::uint32_t body = 1, cloth = 2, scenery = 4;

  supple::Scene scene;
  const supple::TriangleMesh ball = supple::make_icosphere(6);
  const supple::TriangleMesh floor = supple::make_box({8, 0.5, 8}, 4);
  const supple::ObjectId left = scene.add(ball, {.name = "left", .group = body});
  const supple::ObjectId right = scene.add(ball, {.name = "right", .group = body});
  // The ghost is in the group of cloth, and only scenery may touch it.
  const supple::ObjectId ghost = scene.add(ball, {.name = "ghost", .group = cloth, .mask = scenery});
  scene.add(floor, {.name = "floor", .is_static = true, .group = scenery});
  scene.translate(left, {-0.5, 1, 0});
  scene.translate(right, {0.5, 1, 0});
  scene.translate(ghost, {0, 1, 0.5});

  const auto print_pairs = [&scene](const char* title) {
    std::printf("%s:\n", title);
    const supple::DetectResult& result = scene.detect();
    for (const supple::ContactGroup& group : result.groups)
      std::printf("  %s touches %s: %u triangle pairs\n", scene.options(group.a).name.c_str(),
                  scene.options(group.b).name.c_str(), group.contact_count);
  };
  print_pairs("groups and masks");
  scene.set_pair_filter(
      [left, right](supple::ObjectId a, supple::ObjectId b) { return !(a == left && b == right); });
  print_pairs("and left and right are glued together");
}
