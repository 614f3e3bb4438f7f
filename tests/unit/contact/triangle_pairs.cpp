#include "unit/contact/triangle_pairs.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

namespace supple::truth {
namespace {

template <class Coordinate>
TrianglePair3d pair_of(Coordinate coordinate) {
  TrianglePair3d pair;
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    for (Vec3d& point : *triangle) {
      point.x = coordinate();
      point.y = coordinate();
      point.z = coordinate();
    }
  }
  return pair;
}

template <class Change>
void for_each_coordinate(TrianglePair3d& pair, Change change) {
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    for (Vec3d& point : *triangle) {
      for (int axis = 0; axis < 3; ++axis) change(point[axis], axis);
    }
  }
}

TrianglePair3d grid(RandomNumbers& random, int reach) {
  return pair_of([&] { return double(random.between(-reach, reach)); });
}
TrianglePair3d grid3(RandomNumbers& random) {
  return grid(random, 3);
}
TrianglePair3d grid1(RandomNumbers& random) {
  return grid(random, 1);
}
TrianglePair3d uniform(RandomNumbers& random) {
  return pair_of([&] { return random.uniform(-1, 1); });
}
TrianglePair3d single_precision(RandomNumbers& random) {
  return pair_of([&] { return double(static_cast<float>(random.uniform(-1, 1))); });
}

/// Both triangles in a plane such as x + 2 y + 3 z = 0. The coordinates are exact, and no axis is special.
TrianglePair3d tilted_plane(RandomNumbers& random) {
  TrianglePair3d pair = grid(random, 3);
  const int p = random.between(-2, 2), q = random.between(-2, 2), turn = random.between(0, 2);
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    for (Vec3d& point : *triangle) point[turn] = p * point[(turn + 1) % 3] + q * point[(turn + 2) % 3];
  }
  return pair;
}
TrianglePair3d flat(RandomNumbers& random) {
  TrianglePair3d pair = uniform(random);
  const int axis = random.between(0, 2);
  for_each_coordinate(pair, [&](double& value, int at) { value = at == axis ? 0.1 : value; });
  return pair;
}

TrianglePair3d without_area(RandomNumbers& random) {
  TrianglePair3d pair = grid(random, 2);
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    const int kind = random.between(0, 4);
    TrianglePoints& t = *triangle;
    if (kind == 0) t[1] = t[0];
    if (kind == 1) t[1] = t[2] = t[0];
    if (kind >= 2) t[2] = t[0] + (t[1] - t[0]) * double(random.between(-2, 2));
    std::swap(t[static_cast<std::size_t>(random.between(0, 2))], t[0]);
  }
  return pair;
}

/// All corners on one line, so only their order along it decides.
TrianglePair3d on_one_line(RandomNumbers& random) {
  const Vec3d direction{double(random.between(-1, 1)), double(random.between(-1, 1)), 1};
  TrianglePair3d pair;
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    for (Vec3d& point : *triangle) point = direction * double(random.between(-4, 4));
  }
  return pair;
}

TrianglePair3d shared_vertex(RandomNumbers& random) {
  TrianglePair3d pair = uniform(random);
  pair.b[static_cast<std::size_t>(random.between(0, 2))] =
      pair.a[static_cast<std::size_t>(random.between(0, 2))];
  return pair;
}
TrianglePair3d shared_edge(RandomNumbers& random) {
  TrianglePair3d pair = uniform(random);
  const auto i = static_cast<std::size_t>(random.between(0, 2)),
             j = static_cast<std::size_t>(random.between(0, 2));
  pair.b[i] = pair.a[j];
  pair.b[(i + 1) % 3] = pair.a[(j + 2) % 3];
  return pair;
}
TrianglePair3d identical(RandomNumbers& random) {
  TrianglePair3d pair = uniform(random);
  pair.b = pair.a;
  std::swap(pair.b[0], pair.b[static_cast<std::size_t>(random.between(0, 2))]);
  return pair;
}

/// Triangles that touch or nearly touch, on an inexact grid with some coordinates one rounding step off.
TrianglePair3d one_step_off(RandomNumbers& random) {
  TrianglePair3d pair = grid(random, 2);
  for_each_coordinate(pair, [&](double& value, int) {
    value = value * 0.1 + 0.7;
    const int kind = random.between(0, 5);
    if (kind == 0) value = std::nextafter(value, 10);
    if (kind == 1) value = std::nextafter(value, -10);
  });
  return pair;
}
/// A corner of b in the plane of a or on an edge of a, up to rounding.
TrianglePair3d nearly_on(RandomNumbers& random) {
  TrianglePair3d pair = uniform(random);
  const double s = (1 + random.uniform(-1, 1)) / 2,
               t = random.between(0, 1) * (1 - s) * (1 + random.uniform(-1, 1)) / 2;
  pair.b[1] = pair.a[0] + (pair.a[1] - pair.a[0]) * s + (pair.a[2] - pair.a[0]) * t;
  if (random.between(0, 1)) pair.b[2] = pair.a[1] + (pair.a[2] - pair.a[1]) * t;
  return pair;
}

template <int power_of_ten>
TrianglePair3d scaled(RandomNumbers& random) {
  TrianglePair3d pair = random.between(0, 1) ? grid3(random) : nearly_on(random);
  const double scale = power_of_ten == 300    ? 1e300
                       : power_of_ten == 30   ? 1e30
                       : power_of_ten == -30  ? 1e-30
                       : power_of_ten == -300 ? 1e-300
                                              : 0x1p-1074;
  for_each_coordinate(pair, [&](double& value, int) { value *= scale; });
  return pair;
}
/// The largest doubles: differences may overflow.
TrianglePair3d largest(RandomNumbers& random) {
  TrianglePair3d pair = grid(random, 2);
  for_each_coordinate(pair, [&](double& value, int) {
    value *= std::numeric_limits<double>::max() / 2;
    if (random.between(0, 3) == 0) value = std::nextafter(value, 0);
  });
  return pair;
}
/// Each axis has its own scale.
TrianglePair3d scaled_axes(RandomNumbers& random) {
  TrianglePair3d pair = random.between(0, 1) ? grid(random, 2) : nearly_on(random);
  const double units[3] = {std::ldexp(1, random.between(-1074, 1022)), std::ldexp(1, random.between(-60, 60)),
                           std::ldexp(1, random.between(-1074, 1022))};
  for_each_coordinate(pair, [&](double& value, int axis) { value *= units[axis]; });
  return pair;
}
/// Coordinates of very different sizes; some are so small that they matter only in exact arithmetic.
TrianglePair3d all_sizes(RandomNumbers& random) {
  TrianglePair3d pair = grid(random, 2);
  const int reach = random.between(0, 1) ? 100 : 1000;
  for_each_coordinate(pair, [&](double& value, int) {
    const int kind = random.between(0, 5);
    if (kind == 0) value = std::ldexp(value, random.between(-reach, reach));
    if (kind == 1) value += std::ldexp(1, -random.between(20, 52));
  });
  return pair;
}

}  // namespace

const std::vector<PairFamily>& pair_families() {
  static const std::vector<PairFamily> families{
      {"uniform", uniform},
      {"single_precision", single_precision},
      {"grid3", grid3},
      {"grid1", grid1},
      {"tilted_plane", tilted_plane},
      {"flat", flat},
      {"without_area", without_area},
      {"on_one_line", on_one_line},
      {"shared_vertex", shared_vertex},
      {"shared_edge", shared_edge},
      {"identical", identical},
      {"one_step_off", one_step_off},
      {"nearly_on", nearly_on},
      {"scale_1e300", scaled<300>},
      {"scale_1e30", scaled<30>},
      {"scale_1e_minus_30", scaled<-30>},
      {"scale_1e_minus_300", scaled<-300>},
      {"denormal", scaled<-324>},
      {"largest", largest},
      {"scaled_axes", scaled_axes},
      {"all_sizes", all_sizes},
  };
  return families;
}

std::string describe(const TrianglePair3d& pair) {
  std::string text;
  for (const TrianglePoints* triangle : {&pair.a, &pair.b}) {
    for (const Vec3d& point : *triangle) {
      char buffer[120];
      std::snprintf(buffer, sizeof buffer, "(%.17g, %.17g, %.17g) ", point.x, point.y, point.z);
      text += buffer;
    }
    text += '\n';
  }
  return text;
}

}  // namespace supple::truth
