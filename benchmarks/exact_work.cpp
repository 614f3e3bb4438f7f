// Searches inputs for which exact arithmetic is slow, and prints the longest time of one pair for coordinates
// of several ranges as a table in Markdown. A search starts from structured random numbers and then changes
// the slowest input so far. Times are processor times of one thread, the shorter of two runs.
//
//     supple_exact_work [seconds of each search, 5 by default]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>

#include "supple/supple.hpp"
#include "workloads/random_numbers.hpp"

namespace supple::benchmarks {
namespace {

constexpr int mantissa_bits = 53;

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Four points at both ends of a step, and a separation. Not all are used for a pair at rest.
struct Input {
  std::array<Vec3d, 8> points;
  double separation = 0;
};

double& coordinate(Vec3d& p, std::uint32_t axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// Inputs whose coordinates have at most some number of bits.
class Inputs {
 public:
  explicit Inputs(int bits)
      : highest_((bits - mantissa_bits) / 2), lowest_(highest_ - bits + mantissa_bits) {}

  Input make() {
    Input input;
    const std::uint32_t mix = below(5);
    for (Vec3d& p : input.points) p = {number(mix), number(mix), number(mix)};
    input.separation = std::fabs(number(mix));
    if (input.separation == 0) input.separation = std::ldexp(1.0, lowest_);
    arrange(input);
    return input;
  }
  Input changed(Input input) {
    for (std::uint32_t count = 1 + below(3); count > 0; --count) {
      Vec3d& p = any(input);
      double& x = coordinate(p, below(3));
      switch (below(6)) {
        case 0:
          x = number(below(5));
          break;
        case 1:
          x = with_last_bit(x);
          break;
        case 2:
          x = -x;
          break;
        case 3:
          x = coordinate(any(input), below(3));
          break;
        case 4:
          input.separation = std::fabs(number(below(5))) + std::ldexp(1.0, lowest_);
          break;
        default:
          p = any(input);
      }
    }
    return input;
  }

 private:
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_.next() % count); }
  Vec3d& any(Input& input) { return input.points[below(8)]; }

  double mantissa() {
    switch (below(4)) {
      case 0:
        return 1;
      case 1:
        return 1 + std::numeric_limits<double>::epsilon();
      case 2:
        return 1 + below(8) / 8.0;
      default:
        return 1 + below(1u << 31) * 0x1p-31;
    }
  }
  /// `mix` says which exponents: any, the ends of the range, also its middle, one, or small and few lowest.
  double number(std::uint32_t mix) {
    if (below(6) == 0) return 0;
    const int middle = (lowest_ + highest_) / 2;
    const auto any = [&] { return lowest_ + static_cast<int>(below(std::uint32_t(highest_ - lowest_) + 1)); };
    const std::array<int, 3> special{lowest_, highest_, middle};
    int exponent = middle;
    if (mix == 0) exponent = any();
    if (mix == 1) exponent = special[below(2)];
    if (mix == 2) exponent = special[below(3)];
    if (mix == 4) exponent = below(4) == 0 ? lowest_ : middle;
    const double value = std::ldexp(mantissa(), exponent);
    return below(2) == 0 ? value : -value;
  }
  double with_last_bit(double x) const {
    const double next = std::nextafter(x, x < 0 ? -1.0 : 1.0);
    return x == 0 || !std::isfinite(next) ? x : next;
  }
  /// Points at rest, points that coincide, common planes and opposite ends.
  void arrange(Input& input) {
    auto& p = input.points;
    switch (below(8)) {
      case 0:
      case 1:
        for (std::size_t i = 0; i < 4; ++i) {
          if (below(2) == 0) p[i + 4] = p[i];
        }
        break;
      case 2:
        for (std::size_t i = 0; i < 4; ++i) {
          p[i + 4] = p[i];
          double& x = coordinate(p[i + 4], below(3));
          x = -x;
        }
        break;
      case 3:
        any(input) = any(input);
        break;
      case 4: {
        const std::uint32_t axis = below(3);
        const double x = number(2);
        for (Vec3d& q : p) coordinate(q, axis) = x;
        break;
      }
      case 5:
        for (std::size_t i = 0; i < 4; ++i) p[i + 4] = -1.0 * p[i];
        break;
      default:
        break;
    }
  }

  int highest_, lowest_;
  RandomNumbers random_{1};
};

using Call = std::function<void(const Input&)>;

double seconds_of(const Call& call, const Input& input) {
  const double start = thread_seconds();
  call(input);
  return thread_seconds() - start;
}

/// The longest time of a pair that a search of some seconds finds.
double longest_time(const Call& call, int bits, double seconds) {
  constexpr int random_tries = 2000;
  Inputs inputs(bits);
  Input slowest;
  double longest = 0;
  const double end = thread_seconds() + seconds;
  for (int i = 0; thread_seconds() < end; ++i) {
    const Input input = i < random_tries || i % 3 == 0 ? inputs.make() : inputs.changed(slowest);
    double time = seconds_of(call, input);
    if (time > longest) time = std::min(time, seconds_of(call, input));
    if (time <= longest) continue;
    longest = time;
    slowest = input;
  }
  return longest;
}

template <class Motion>
Call impact_call(bool with_separation, bool skip_parting) {
  return [=](const Input& input) {
    const auto& p = input.points;
    ImpactOptions options;
    options.min_separation = with_separation ? input.separation : 0;
    options.skip_parting = skip_parting;
    first_impact(Motion{{p[0], p[1], p[2], p[3]}, {p[4], p[5], p[6], p[7]}}, options);
  };
}

void run(double seconds) {
  const auto infinity = std::numeric_limits<double>::infinity();
  struct Row {
    const char* name;
    Call call;
  };
  const Row rows[] = {
      {"two triangles",
       [](const Input& i) {
         const auto& p = i.points;
         intersect_triangles({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
       }},
      {"distance of a point and a triangle",
       [=](const Input& i) {
         const auto& p = i.points;
         point_triangle_distance(p[0], {p[1], p[2], p[3]}, infinity);
       }},
      {"distance of two edges",
       [=](const Input& i) {
         const auto& p = i.points;
         edge_edge_distance({p[0], p[1]}, {p[2], p[3]}, infinity);
       }},
      {"impact of a vertex and a face", impact_call<VertexFaceMotion>(false, false)},
      {"impact of two edges", impact_call<EdgeEdgeMotion>(false, false)},
      {"the same with a separation, vertex and face", impact_call<VertexFaceMotion>(true, false)},
      {"the same with a separation, two edges", impact_call<EdgeEdgeMotion>(true, false)},
      {"and with `skip_parting`, vertex and face", impact_call<VertexFaceMotion>(true, true)},
      {"and with `skip_parting`, two edges", impact_call<EdgeEdgeMotion>(true, true)},
  };
  constexpr int ranges[] = {53, 120, 250, 500, 1000, 2098};
  std::printf("| Pair |");
  for (const int bits : ranges) std::printf(" %d bits |", bits);
  std::printf("\n|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    std::printf("| %s |", row.name);
    for (const int bits : ranges) {
      std::printf(" %.3g ms |", 1e3 * longest_time(row.call, bits, seconds));
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace supple::benchmarks

int main(int argc, char** argv) {
  supple::benchmarks::run(argc > 1 ? std::atof(argv[1]) : 5);
}
