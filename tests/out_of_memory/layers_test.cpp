// When a layer does not fit in memory, the session reports it, names the disabled layers and continues.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "steady_state/allocation_count.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer::layers_test {

using Json = nlohmann::json;

constexpr std::size_t large = 1'000'000;

/// While this object exists, allocations of `large` bytes or more fail.
class Scarcity {
 public:
  Scarcity() { refuse_allocations_from(large); }
  ~Scarcity() { refuse_allocations_from(std::size_t(-1)); }
  Scarcity(const Scarcity&) = delete;
  Scarcity& operator=(const Scarcity&) = delete;
};

/// Coincident triangles that give 90,000 candidate pairs.
SceneView two_heaps() {
  SceneView show;
  for (const char* name : {"heap", "other heap"}) {
    ViewedObject heap;
    heap.mesh.name = name;
    for (std::uint32_t i = 0; i < 300; ++i) {
      heap.mesh.positions.insert(heap.mesh.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.001 * i}});
      heap.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    show.objects.push_back(std::move(heap));
  }
  return show;
}

TEST(OutOfMemory, ALayerThatFailsIsGivenUpWithTheOthersAndTheyAreNamed) {
  TestPage page(two_heaps());
  page.scene();
  page.frame();
  page.ask({{"do", "layers"}, {"candidates", true}, {"octree", {{"objects", {0}}, {"level", 0}}}});
  page.say({{"do", "credit"}, {"frames", 1}});
  Json failure;
  std::span<const std::byte> next;
  {
    const Scarcity scarcity;
    const ViewerMessage message(page.next_bytes());
    EXPECT_EQ(message.kind, ViewerMessage::failure);
    failure = message.json;
    next = page.next_bytes();
  }
  const ViewerMessage without(next);  // uses the credit that the failure did not consume
  EXPECT_EQ(failure["fatal"], false);
  EXPECT_FALSE(failure.contains("id"));
  EXPECT_EQ(failure["layers"], (Json{"candidates", "octree"}));
  EXPECT_NE(failure["message"].get<std::string>().find("memory"), std::string::npos);
  EXPECT_EQ(without.kind, ViewerMessage::frame);
  EXPECT_FALSE(without.has(38) || without.has(40, 0));

  // The layers return on request: they were disabled, not forbidden.
  page.ask({{"do", "layers"}, {"candidates", true}});
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.section(38).count, 90'000u);
  EXPECT_FALSE(frame.has(40, 0));
}

TEST(OutOfMemory, AFrameWithoutLayersThatFailsEndsTheSession) {
  TestPage page(two_heaps());
  page.scene();
  page.say({{"do", "credit"}, {"frames", 1}});
  const Scarcity scarcity;
  const Json failure = page.only(ViewerMessage::failure).json;
  EXPECT_EQ(failure["fatal"], true);
  EXPECT_FALSE(failure.contains("layers"));
  EXPECT_TRUE(page.session.ended());
}

}  // namespace supple::viewer::layers_test
