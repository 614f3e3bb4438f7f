#include "unit/contact/triangle_pairs.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

namespace supple::testing {
namespace {

// Not std::uniform_*_distribution, whose numbers differ between standard libraries.
int integer(Random& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}
double real(Random& random) {
  return static_cast<double>(static_cast<std::int64_t>(random()) >> 11) * 0x1p-52;
}

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

TrianglePair3d grid(Random& random, int reach) {
  return pair_of([&] { return double(integer(random, -reach, reach)); });
}
TrianglePair3d grid3(Random& random) {
  return grid(random, 3);
}
TrianglePair3d grid1(Random& random) {
  return grid(random, 1);
}
TrianglePair3d uniform(Random& random) {
  return pair_of([&] { return real(random); });
}
TrianglePair3d single_precision(Random& random) {
  return pair_of([&] { return double(static_cast<float>(real(random))); });
}

/// In the plane x + 2 y + 3 z = 0 or one of its like: exact, and no axis is special.
TrianglePair3d tilted_plane(Random& random) {
  TrianglePair3d pair = grid(random, 3);
  const int p = integer(random, -2, 2), q = integer(random, -2, 2), turn = integer(random, 0, 2);
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    for (Vec3d& point : *triangle) point[turn] = p * point[(turn + 1) % 3] + q * point[(turn + 2) % 3];
  }
  return pair;
}
TrianglePair3d flat(Random& random) {
  TrianglePair3d pair = uniform(random);
  const int axis = integer(random, 0, 2);
  for_each_coordinate(pair, [&](double& value, int at) { value = at == axis ? 0.1 : value; });
  return pair;
}

TrianglePair3d without_area(Random& random) {
  TrianglePair3d pair = grid(random, 2);
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    const int kind = integer(random, 0, 4);
    TrianglePoints& t = *triangle;
    if (kind == 0) t[1] = t[0];
    if (kind == 1) t[1] = t[2] = t[0];
    if (kind >= 2) t[2] = t[0] + (t[1] - t[0]) * double(integer(random, -2, 2));
    std::swap(t[static_cast<std::size_t>(integer(random, 0, 2))], t[0]);
  }
  return pair;
}

/// On one line, so that only the order along it decides.
TrianglePair3d on_one_line(Random& random) {
  const Vec3d direction{double(integer(random, -1, 1)), double(integer(random, -1, 1)), 1};
  TrianglePair3d pair;
  for (TrianglePoints* triangle : {&pair.a, &pair.b}) {
    for (Vec3d& point : *triangle) point = direction * double(integer(random, -4, 4));
  }
  return pair;
}

TrianglePair3d shared_vertex(Random& random) {
  TrianglePair3d pair = uniform(random);
  pair.b[static_cast<std::size_t>(integer(random, 0, 2))] =
      pair.a[static_cast<std::size_t>(integer(random, 0, 2))];
  return pair;
}
TrianglePair3d shared_edge(Random& random) {
  TrianglePair3d pair = uniform(random);
  const auto i = static_cast<std::size_t>(integer(random, 0, 2)),
             j = static_cast<std::size_t>(integer(random, 0, 2));
  pair.b[i] = pair.a[j];
  pair.b[(i + 1) % 3] = pair.a[(j + 2) % 3];
  return pair;
}
TrianglePair3d identical(Random& random) {
  TrianglePair3d pair = uniform(random);
  pair.b = pair.a;
  std::swap(pair.b[0], pair.b[static_cast<std::size_t>(integer(random, 0, 2))]);
  return pair;
}

/// Touching or nearly: a grid that doubles do not hold exactly, some coordinates one step off.
TrianglePair3d one_step_off(Random& random) {
  TrianglePair3d pair = grid(random, 2);
  for_each_coordinate(pair, [&](double& value, int) {
    value = value * 0.1 + 0.7;
    const int kind = integer(random, 0, 5);
    if (kind == 0) value = std::nextafter(value, 10);
    if (kind == 1) value = std::nextafter(value, -10);
  });
  return pair;
}
/// A corner of b in the rounded plane or on a rounded edge of a.
TrianglePair3d nearly_on(Random& random) {
  TrianglePair3d pair = uniform(random);
  const double s = (1 + real(random)) / 2, t = integer(random, 0, 1) * (1 - s) * (1 + real(random)) / 2;
  pair.b[1] = pair.a[0] + (pair.a[1] - pair.a[0]) * s + (pair.a[2] - pair.a[0]) * t;
  if (integer(random, 0, 1)) pair.b[2] = pair.a[1] + (pair.a[2] - pair.a[1]) * t;
  return pair;
}

template <int power_of_ten>
TrianglePair3d scaled(Random& random) {
  TrianglePair3d pair = integer(random, 0, 1) ? grid3(random) : nearly_on(random);
  const double scale = power_of_ten == 300    ? 1e300
                       : power_of_ten == 30   ? 1e30
                       : power_of_ten == -30  ? 1e-30
                       : power_of_ten == -300 ? 1e-300
                                              : 0x1p-1074;
  for_each_coordinate(pair, [&](double& value, int) { value *= scale; });
  return pair;
}
/// The largest doubles: every difference may overflow.
TrianglePair3d largest(Random& random) {
  TrianglePair3d pair = grid(random, 2);
  for_each_coordinate(pair, [&](double& value, int) {
    value *= std::numeric_limits<double>::max() / 2;
    if (integer(random, 0, 3) == 0) value = std::nextafter(value, 0);
  });
  return pair;
}
/// Each axis in a unit of its own.
TrianglePair3d scaled_axes(Random& random) {
  TrianglePair3d pair = integer(random, 0, 1) ? grid(random, 2) : nearly_on(random);
  const double units[3] = {std::ldexp(1, integer(random, -1074, 1022)),
                           std::ldexp(1, integer(random, -60, 60)),
                           std::ldexp(1, integer(random, -1074, 1022))};
  for_each_coordinate(pair, [&](double& value, int axis) { value *= units[axis]; });
  return pair;
}
/// Coordinates of all sizes beside one another, some small enough to matter only exactly.
TrianglePair3d all_sizes(Random& random) {
  TrianglePair3d pair = grid(random, 2);
  const int reach = integer(random, 0, 1) ? 100 : 1000;
  for_each_coordinate(pair, [&](double& value, int) {
    const int kind = integer(random, 0, 5);
    if (kind == 0) value = std::ldexp(value, integer(random, -reach, reach));
    if (kind == 1) value += std::ldexp(1, -integer(random, 20, 52));
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

}  // namespace supple::testing
