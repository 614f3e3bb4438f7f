// Safe steps of objects that touch at the start: they end there only where surfaces come to cross.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple::touching_step_test {

struct Moving {
  TriangleMesh mesh;
  std::vector<Vec3d> to;
};

Moving moving(TriangleMesh mesh, Vec3d way) {
  Moving result{std::move(mesh), {}};
  for (const Vec3d& p : result.mesh.positions) result.to.push_back(p + way);
  return result;
}
TriangleMesh at(TriangleMesh mesh, Vec3d place) {
  for (Vec3d& p : mesh.positions) p += place;
  return mesh;
}
TriangleMesh face(std::vector<Vec3d> corners) {
  TriangleMesh mesh;
  mesh.positions = std::move(corners);
  for (std::uint32_t i = 2; i < mesh.positions.size(); ++i) mesh.triangles.push_back({0, i - 1, i});
  return mesh;
}
TriangleMesh plate(double size, double height = 0) {
  return face({{-size, -size, height}, {size, -size, height}, {size, size, height}, {-size, size, height}});
}

struct Steps {
  double free, longest, of_object;
  bool operator==(const Steps&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Steps& s) {
  return out << s.free << " " << s.longest << " " << s.of_object;
}

Steps steps(const std::vector<Moving>& objects, double separation = 0, double keep = 0.2,
            std::uint32_t threads = 1) {
  Scene scene(
      {.contacts = ContactKinds::continuous, .impact = {.min_separation = separation}, .threads = threads});
  for (const Moving& object : objects)
    scene.set_motion(scene.add(object.mesh), object.mesh.positions, object.to);
  Steps found{scene.collision_free_step({.keep = keep}).step, scene.max_step().step, 1};
  for (const ObjectStep& step : scene.collision_free_steps({.keep = keep}))
    found.of_object = std::min(found.of_object, step.safe.step);
  return found;
}

constexpr Steps all{1, 1, 1}, none{0, 0, 0};

constexpr Vec3d up{0, 0, 1}, down{0, 0, -1}, still{}, aslant{0.25, 0.125, 0.5};

/// The second object moves by each way, the first is at rest. Ways aslant bring elements nearer to each other
/// that are apart at the start, so that only without a share to keep nothing limits the step.
void expect_steps(const TriangleMesh& rest, const TriangleMesh& mesh, const std::vector<Vec3d>& apart,
                  const std::vector<Vec3d>& against, const std::string& what) {
  const auto expect = [&](const Vec3d& way, double keep, const Steps& expected) {
    EXPECT_EQ(steps({moving(rest, {}), moving(mesh, way)}, 0, keep), expected)
        << what << " " << way.x << " " << way.z;
    EXPECT_EQ(steps({moving(mesh, way), moving(rest, {})}, 0, keep, 2), expected)
        << what << ", swapped " << way.x << " " << way.z;
  };
  for (const Vec3d& way : apart) expect(way, 0, all);
  for (const double keep : {0.2, 0.9}) {
    if (!apart.empty() && apart[0] == up) expect(up, keep, all);
    expect(still, keep, all);
    for (const Vec3d& way : against) expect(way, keep, none);
  }
}

TEST(TouchingSteps, OfPlatesOnAFloor) {
  expect_steps(plate(4), plate(1), {up, still, aslant, {0.5, 0, 0}}, {down, {0.25, 0, -0.5}}, "plate");
  // In any tessellation, because the floor is at rest.
  const auto grid = [](std::uint32_t count, double size) {
    TriangleMesh mesh = make_cloth(count, count, size, size);
    for (Vec3d& p : mesh.positions) p = {p.x, -p.z, 0};  // its faces look up
    return mesh;
  };
  expect_steps(grid(5, 4), grid(7, 3), {up, still, aslant}, {down}, "cloth");
}

TEST(TouchingSteps, OfBodies) {
  const TriangleMesh box = make_box({1, 1, 1}, 2);
  const auto on_top = [&](const TriangleMesh& mesh, Vec3d place) { return at(mesh, place); };
  expect_steps(plate(4, -0.5), box, {up, still, aslant}, {down}, "box on a floor");
  expect_steps(box, on_top(box, {0, 0, 1}), {up, still, aslant}, {down, {0.25, 0.25, -0.5}}, "equal boxes");
  expect_steps(box, on_top(box, {0.25, 0.375, 1}), {up, still, aslant}, {down}, "shifted boxes");
  expect_steps(box, on_top(make_box({3, 0.25, 0.25}, 1), {0, 0, 0.625}), {up, still, aslant}, {down},
               "crossing bar");
  expect_steps(box, on_top(box, {1, 0, 0}), {{1, 0, 0}, still}, {{-1, 0, 0}}, "side by side");
  expect_steps(box, on_top(box, {1, 1, 0}), {{1, 1, 0}, {1, 0, 0}, {0, 1, 0}, still}, {{-1, -1, 0}},
               "edge on edge");
  expect_steps(box, on_top(box, {1, 1, 1}), {{1, 1, 1}, {1, 0, 0}, still}, {{-1, -1, -1}},
               "corner on corner");
}

TEST(TouchingSteps, OfABoxInACornerOfARoom) {
  // The outer side of the room is its inside.
  TriangleMesh room;
  room.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 4, 0}, {4, 0, 4}, {0, 4, 4}};
  room.triangles = {{0, 1, 4}, {0, 4, 2}, {0, 2, 6}, {0, 6, 3}, {0, 3, 5}, {0, 5, 1}};
  const TriangleMesh box = at(make_box({1, 1, 1}, 1), {0.5, 0.5, 0.5});
  expect_steps(room, box, {{1, 1, 1}, {0, 0, 0.5}, {0.5, 0, 0}, {0.5, 0, 0.5}, still},
               {{-1, 0, 0}, {0, 0, -1}, {-1, -1, -1}, {1, 1, -1}, {-0.5, 0, 1}}, "room");
}

/// Features of single triangles, which have two sides: a triangle stays on the side on which it is.
TEST(TouchingSteps, OfFeatures) {
  const TriangleMesh floor = plate(4), turned = face({{-4, -4, 0}, {-4, 4, 0}, {4, 4, 0}, {4, -4, 0}});
  for (const TriangleMesh& rest : {floor, turned}) {
    const TriangleMesh standing = face({{1, 0.5, 0}, {1, 0, 1}, {1, 1, 1}}),
                       hanging = face({{1, 0.5, 0}, {1, 0, -1}, {1, 1, -1}});
    expect_steps(rest, standing, {up, still, aslant, {0.25, 0, 0}}, {down}, "vertex on face");
    expect_steps(rest, hanging, {down, still, {0.25, 0, 0}}, {up}, "vertex below face");
  }
  const TriangleMesh roof = face({{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}});
  expect_steps(roof, face({{0, -1, 0}, {0, 1, 0}, {0, 0, 1}}), {up, still, aslant}, {down}, "edge on edge");
  expect_steps(roof, face({{1, 0, 0}, {2, -1, 1}, {2, 1, 1}}), {up, {1, 0, 0}, still}, {},
               "vertex on vertex");
}

TEST(TouchingSteps, OfRotationsAndSingleVertices) {
  const TriangleMesh floor = plate(4), tile = plate(1);
  Moving tilting = moving(tile, {});
  for (const std::size_t v : {2u, 3u}) tilting.to[v].z += 0.5;
  EXPECT_EQ(steps({moving(floor, {}), tilting}), all);
  Moving one = moving(tile, {});
  one.to[2].z += 0.5;
  EXPECT_EQ(steps({moving(floor, {}), one}), all);
  one.to[0].z -= 0x1p-40;
  EXPECT_EQ(steps({moving(floor, {}), one}), none);
}

/// They part, and meet again at half of the step.
TEST(TouchingSteps, EndWhereElementsTouchAgain) {
  Moving vertex = moving(face({{1, 0.5, 0}, {1, 0, 1}, {1, 1, 1}}), {0, 0, 1});
  Moving floor = moving(plate(4), {});
  // The floor turns about the line y = 0 and comes back to the vertex.
  vertex.to = {{1, 0.5, -1}, {1, 0, 1}, {1, 1, 1}};
  EXPECT_EQ(steps({floor, vertex}), none);
  for (const double keep : {0.0, 0.5}) {
    // z of the vertex above the moving plane is t (1 - 2 t) / 2.
    Moving rising = moving(face({{0, 1, 0}, {0, 1, 3}, {0.5, 1, 3}}), {0, 0, 0});
    rising.to[0] = {0, 2, 1.5};
    rising.to[1].z += 2, rising.to[2].z += 2;
    Moving turning = moving(face({{-4, 0, 0}, {4, 0, 0}, {0, 8, 0}}), {});
    turning.to[2].z += 8;
    const Steps found = steps({turning, rising}, 0, keep);
    EXPECT_GT(found.free, 0);
    EXPECT_LE(found.free, found.longest * (1 + 0x1p-20));
    EXPECT_EQ(found.of_object, found.free);
  }
}

TEST(TouchingSteps, WithSeparations) {
  for (const double gap : {0.0, 0.125, 0.25}) {
    const TriangleMesh floor = plate(4), tile = plate(1, gap);
    EXPECT_EQ(steps({moving(floor, {}), moving(tile, up)}, 0.25), all) << gap;
    EXPECT_EQ(steps({moving(floor, {}), moving(tile, still)}, 0.25), all) << gap;
    const Steps down_steps = steps({moving(floor, {}), moving(tile, down)}, 0.25);
    EXPECT_EQ(down_steps.longest, 0) << gap;
    EXPECT_NEAR(down_steps.free, 0.8 * gap, 1e-5) << gap;
  }
}

TEST(TouchingSteps, OfManyPairs) {
  std::vector<Moving> boxes;
  for (int i = 0; i < 5; ++i)
    boxes.push_back(moving(at(make_box({1, 1, 1}, 1), {0, 0, 1.0 * i}), {0, 0, 0.5 * i}));
  EXPECT_EQ(steps(boxes), all);
  boxes.back() = moving(boxes.back().mesh, {0, 0, 1.25});
  EXPECT_EQ(steps(boxes), none);
}

/// Random motions of single triangles that share a point: the step is 0 exactly where an edge of one passes
/// through the other just after the start, as crossings at a late moment of a tiny step show.
TEST(TouchingSteps, AgreeWithCrossingsJustAfterTheStart) {
  RandomNumbers random(11);
  int parting = 0, crossing = 0;
  for (int round = 0; round < 400; ++round) {
    const auto coarse = [&] {
      return Vec3d{std::round(4 * random.uniform(-1, 1)) / 4, std::round(4 * random.uniform(-1, 1)) / 4,
                   std::round(4 * random.uniform(-1, 1)) / 4};
    };
    TriangleMesh a = face({{-2, -2, 0}, {2, -2, 0}, {0, 2, 0}}),
                 b = face({Vec3d{0, -0.5, 0}, coarse(), coarse()});
    if (round % 2 == 0) b.positions[0] = {0, 2, 0};
    if (b.positions[1].z * b.positions[2].z <= 0)
      continue;  // one side of the plane, so apart but for the point
    Moving moving_b = moving(b, {});
    for (Vec3d& p : moving_b.to) p = p + coarse();
    Scene scene({.contacts = ContactKinds::intersection, .threads = 1});
    scene.add(a);
    std::vector<Vec3d> soon;
    for (std::size_t v = 0; v < 3; ++v)
      soon.push_back(b.positions[v] + 0x1p-20 * (moving_b.to[v] - b.positions[v]));
    TriangleMesh later = b;
    later.positions = soon;
    scene.add(later);
    const bool crosses = !scene.detect().contacts.empty();
    const double step = steps({moving(a, {}), moving_b}, 0, 0).free;
    const bool slides = soon[0].z == 0;
    if (slides) continue;
    EXPECT_EQ(step == 0, crosses) << round;
    (crosses ? crossing : parting) += 1;
  }
  EXPECT_GT(parting, 50);
  EXPECT_GT(crossing, 50);
}

/// Whether boxes with sides along the axes have a common inner point at a part of their ways, exactly: all
/// numbers are multiples of 2^-20.
bool overlap_at(const Vec3d& size_a, const Vec3d& way_a, const Vec3d& place_b, const Vec3d& size_b,
                const Vec3d& way_b, double part) {
  for (int axis = 0; axis < 3; ++axis) {
    const double gap =
        std::abs(place_b[axis] + part * (way_b[axis] - way_a[axis])) - (size_a[axis] + size_b[axis]) / 2;
    if (gap >= 0) return false;
  }
  return true;
}

/// Random boxes that touch: flush, corner on edge, edge on edge, and so on. The step is 0 exactly where they
/// overlap just after the start, and never longer than up to where they do.
TEST(TouchingSteps, OfRandomBoxesEndWhereTheyOverlap) {
  RandomNumbers random(17);
  int parting = 0, against = 0;
  for (int round = 0; round < 600; ++round) {
    const auto quarters = [&](int low, int high) { return 0.25 * random.between(low, high); };
    const auto vector = [&](int low, int high) {
      return Vec3d{quarters(low, high), quarters(low, high), quarters(low, high)};
    };
    const Vec3d size_a = vector(1, 4), size_b = vector(1, 4);
    Vec3d place{};
    const auto touching = static_cast<int>(random.below(3));
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = (size_a[axis] + size_b[axis]) / 2;
      const bool touches = axis == touching || random.below(4) == 0;
      place[axis] = touches ? (random.below(2) == 0 ? reach : -reach) : reach * 0.25 * random.between(-3, 3);
    }
    const Vec3d way_a = random.below(2) == 0 ? Vec3d{} : vector(-2, 2), way_b = vector(-2, 2);
    const auto resolution = [&] { return 1 + random.below(2); };
    const TriangleMesh a = make_box(size_a, resolution()), b = at(make_box(size_b, resolution()), place);
    const Steps found = steps({moving(a, way_a), moving(b, way_b)}, 0, 0);
    const bool crosses = overlap_at(size_a, way_a, place, size_b, way_b, 0x1p-10);
    EXPECT_EQ(found.longest == 0, crosses) << round;
    EXPECT_EQ(found.free == 0, crosses) << round;
    EXPECT_EQ(found.of_object == 0, crosses) << round;
    for (const double part : {0.125, 0.5, 1.0}) {
      EXPECT_FALSE(overlap_at(size_a, way_a, place, size_b, way_b, part * found.longest)) << round;
      EXPECT_FALSE(overlap_at(size_a, way_a, place, size_b, way_b, part * found.free)) << round;
    }
    (crosses ? against : parting) += 1;
  }
  EXPECT_GT(parting, 150);
  EXPECT_GT(against, 100);
}

}  // namespace supple::touching_step_test
