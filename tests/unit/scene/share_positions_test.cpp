#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <span>
#include <tuple>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/instruction_sets.hpp"
#include "support/scenes.hpp"
#include "support/soups.hpp"

namespace supple::share_positions_test {

using ContactKeys = std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>>;

ContactKeys keys_of(const DetectResult& result) {
  ContactKeys keys;
  for (const Contact& c : result.contacts)
    keys.emplace_back(c.object_a.index, c.object_b.index, c.triangle_a, c.triangle_b);
  return keys;
}

/// Points that end at the last byte before a protected page: a read past the last point crashes.
template <class Scalar>
class PointsAtTheEnd {
 public:
  explicit PointsAtTheEnd(std::size_t count, std::size_t stride = 3) : count_(count), stride_(stride) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t needed = (stride * (count - 1) + 3) * sizeof(Scalar);
    pages_ = (needed + page - 1) / page * page;
    memory_ = mmap(nullptr, pages_ + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED) throw std::bad_alloc();
    mprotect(static_cast<char*>(memory_) + pages_, page, PROT_NONE);
    first_ = reinterpret_cast<Scalar*>(static_cast<char*>(memory_) + pages_ - needed);
  }
  ~PointsAtTheEnd() { munmap(memory_, pages_ + static_cast<std::size_t>(sysconf(_SC_PAGESIZE))); }
  PointsAtTheEnd(const PointsAtTheEnd&) = delete;
  PointsAtTheEnd& operator=(const PointsAtTheEnd&) = delete;

  void set(std::span<const Vec3d> points, Vec3d offset = {}) {
    for (std::size_t i = 0; i < count_; ++i) {
      for (int axis = 0; axis < 3; ++axis)
        first_[stride_ * i + static_cast<std::size_t>(axis)] =
            static_cast<Scalar>(points[i][axis] + offset[axis]);
    }
  }
  PositionsView view() const {
    return {first_, count_, static_cast<std::ptrdiff_t>(stride_ * sizeof(Scalar))};
  }

 private:
  std::size_t count_, stride_, pages_ = 0;
  void* memory_ = nullptr;
  Scalar* first_ = nullptr;
};

template <class Scalar>
class SharePositions : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SharePositions, Scalars);

TYPED_TEST(SharePositions, FindsWhatACopyFindsAndReadsNothingElse) {
  const TriangleMesh ball = make_icosphere(6), sheet = crumpled_sheet(20, 20, 0.03, 3);
  for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    for (const std::size_t stride : {3u, 5u}) {
      for (const BoundingVolume volume : all_bounding_volumes) {
        PointsAtTheEnd<TypeParam> a(ball.positions.size(), stride), b(sheet.positions.size(), stride);
        SceneOptions options;
        options.threads = 2;
        options.bounding_volume = volume;
        Scene shared(options), copied(options);
        const ObjectId ids[] = {shared.add(ball), shared.add(sheet, {.self_collision = true})};
        copied.add(ball);
        copied.add(sheet, {.self_collision = true});
        std::size_t contacts = 0;
        for (int step = 0; step < 4; ++step) {
          a.set(ball.positions, {0.3 * step, 0.1, 0});
          b.set(sheet.positions, {0, 0.2 * step, 0});
          shared.share_positions(ids[0], a.view());
          shared.share_positions(ids[1], b.view());
          copied.set_positions(ids[0], a.view());
          copied.set_positions(ids[1], b.view());
          const ContactKeys found = keys_of(shared.detect());
          EXPECT_EQ(found, keys_of(copied.detect()));
          EXPECT_EQ(SceneInspector(shared).validate(), "");
          EXPECT_TRUE(verify(shared).agrees());
          contacts += found.size();
        }
        EXPECT_GT(contacts, 100u);
      }
    }
  });
}

TYPED_TEST(SharePositions, CanBeMovedAsAWhole) {
  const TriangleMesh ball = make_icosphere(5);
  PointsAtTheEnd<TypeParam> points(ball.positions.size());
  points.set(ball.positions);
  Scene shared, copied;
  for (Scene* const scene : {&shared, &copied}) {
    scene->add(ball);
    scene->add(ball);
  }
  const ObjectId moved = shared.objects()[1];
  const auto expect_equal = [&] {
    const ContactKeys found = keys_of(shared.detect());
    EXPECT_FALSE(found.empty());
    EXPECT_EQ(found, keys_of(copied.detect()));
    EXPECT_EQ(shared.position(moved, 7), copied.position(moved, 7));
  };
  shared.share_positions(moved, points.view());
  copied.set_positions(moved, points.view());
  for (Scene* const scene : {&shared, &copied}) scene->translate(moved, {0.4, 0.2, 0.1});
  expect_equal();
  RigidTransform turned;
  turned.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  turned.translation = {0.3, 0.7, 0};
  for (Scene* const scene : {&shared, &copied}) scene->set_transform(moved, turned);
  expect_equal();
  for (Scene* const scene : {&shared, &copied}) scene->translate(moved, {1e32, 0, 0});
  for (Scene* const scene : {&shared, &copied}) scene->translate(moved, {-1e32, 0, 0});
  points.set(ball.positions, {0, 0, 1});
  shared.share_positions(moved, points.view());
  copied.set_positions(moved, points.view());
  expect_equal();
}

TYPED_TEST(SharePositions, NonFiniteVerticesAreFoundWhenTheyAreRead) {
  const TriangleMesh ball = make_icosphere(4);
  PointsAtTheEnd<TypeParam> points(ball.positions.size());
  Scene scene;
  const ObjectId id = scene.add(ball);
  scene.add(ball);
  std::vector<Vec3d> broken = ball.positions;
  broken.back().y = std::numeric_limits<double>::quiet_NaN();
  points.set(broken, {0.5, 0, 0});
  scene.share_positions(id, points.view());
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.non_finite_vertices.size(), 1u);
  EXPECT_EQ(result.non_finite_vertices[0].vertex, broken.size() - 1);
  EXPECT_FALSE(result.contacts.empty());
  EXPECT_TRUE(verify(scene).agrees());
  points.set(ball.positions, {0.5, 0, 0});
  scene.share_positions(id, points.view());
  EXPECT_TRUE(scene.detect().non_finite_vertices.empty());
  EXPECT_TRUE(verify(scene).agrees());
}

TYPED_TEST(SharePositions, AreReadForContinuousContactsToo) {
  const TriangleMesh ball = make_icosphere(4);
  std::vector<Vec3<TypeParam>> points;
  for (const Vec3d& p : ball.positions)
    points.push_back(
        {static_cast<TypeParam>(p.x + 0.5), static_cast<TypeParam>(p.y), static_cast<TypeParam>(p.z)});
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  Scene scene(options);
  const ObjectId id = scene.add(ball);
  scene.add(ball);
  scene.share_positions(id, points);
  EXPECT_FALSE(scene.detect().continuous_contacts.empty());
  points.assign(points.size(), {100, 100, 100});
  scene.share_positions(id, points);
  EXPECT_TRUE(scene.detect().continuous_contacts.empty());
}

TYPED_TEST(SharePositions, CopiesWhatItCannotReadInPlace) {
  using Scalar = TypeParam;
  const TriangleMesh ball = make_icosphere(2);
  const std::size_t n = ball.positions.size();
  constexpr std::ptrdiff_t size = sizeof(Scalar), odd = 3 * size + 1;
  std::vector<Scalar> reversed(3 * n), columns(3 * n);
  std::vector<std::byte> unaligned(static_cast<std::size_t>(odd) * n + 1);
  for (std::size_t v = 0; v < n; ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<Scalar>(ball.positions[v][static_cast<int>(axis)] + 0.3);
      reversed[3 * (n - 1 - v) + axis] = columns[axis * n + v] = x;
      std::memcpy(unaligned.data() + 1 + static_cast<std::size_t>(odd) * v + axis * sizeof(Scalar), &x,
                  sizeof(Scalar));
    }
  }
  const auto* const odd_place = reinterpret_cast<const Scalar*>(unaligned.data() + 1);
  const std::vector<PositionsView> views{
      {reversed.data() + 3 * (n - 1), n, -3 * size},
      {columns.data(), n, size, static_cast<std::ptrdiff_t>(n) * size},
      {odd_place, n, odd},
  };
  for (const PositionsView& view : views) {
    Scene shared, copied;
    for (Scene* scene : {&shared, &copied}) scene->add(ball);
    const ObjectId of_shared = shared.add(ball), of_copied = copied.add(ball);
    shared.share_positions(of_shared, view);
    copied.set_positions(of_copied, view);
    EXPECT_EQ(keys_of(shared.detect()), keys_of(copied.detect()));
    EXPECT_FALSE(shared.result().contacts.empty());
    EXPECT_TRUE(verify(shared).agrees());
  }
}

TEST(SharePositions, ChecksWhatItIsGiven) {
  Scene scene;
  const ObjectId id = scene.add(make_icosphere(2));
  const std::vector<Vec3f> few(3);
  EXPECT_THROW(scene.share_positions(id, few), Error);
  scene.set_options(id, {.is_static = true});
  const std::vector<Vec3f> enough(scene.vertex_count(id));
  EXPECT_THROW(scene.share_positions(id, enough), Error);
}

}  // namespace supple::share_positions_test
