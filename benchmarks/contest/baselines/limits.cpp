#include "contest/baselines/limits.hpp"

#include <hwy/highway.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>
#include <type_traits>

#include "contest/contestant.hpp"

namespace supple::benchmarks {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

std::uint64_t sum_of(const std::vector<std::uint64_t>& words) {
  const hn::ScalableTag<std::uint64_t> d;
  const std::size_t lanes = hn::Lanes(d);
  auto a = hn::Zero(d), b = a, c = a, e = a;
  std::size_t i = 0;
  for (; i + 4 * lanes <= words.size(); i += 4 * lanes) {
    a = hn::Add(a, hn::LoadU(d, &words[i]));
    b = hn::Add(b, hn::LoadU(d, &words[i + lanes]));
    c = hn::Add(c, hn::LoadU(d, &words[i + 2 * lanes]));
    e = hn::Add(e, hn::LoadU(d, &words[i + 3 * lanes]));
  }
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
}

/// Inserts two zero bits between each two bits of a coordinate.
std::uint64_t spread_bits(std::uint64_t x) {
  std::uint64_t result = 0;
  for (int bit = 0; bit < 20; ++bit) result |= (x >> bit & 1) << (3 * bit);
  return result;
}

std::vector<std::uint32_t> morton_order(const TriangleMesh& mesh) {
  Vec3d low = mesh.positions.front(), high = low;
  for (const Vec3d& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> codes;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Vec3d center = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0 / 3);
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double unit = (center[axis] - low[axis]) / std::max(high[axis] - low[axis], 1e-300);
      code |= spread_bits(static_cast<std::uint64_t>(unit * 0xfffff)) << axis;
    }
    codes.emplace_back(code, i);
  }
  std::sort(codes.begin(), codes.end());
  std::vector<std::uint32_t> order;
  for (const auto& [code, triangle] : codes) order.push_back(triangle);
  return order;
}

}  // namespace

/// The fourth coordinate is unused.
struct IdealRefit::Corners {
  hn::Vec<hn::Full128<float>> low, high;
};

double read_bandwidth(std::size_t bytes, unsigned threads) {
  constexpr int rounds = 7;
  const std::size_t words = bytes / threads / sizeof(std::uint64_t);
  const auto repetitions = std::max<std::size_t>(1, (std::size_t{256} << 20) / bytes);
  std::vector<std::vector<std::uint64_t>> arrays(threads, std::vector<std::uint64_t>(words, 1));
  double best = 0;
  for (int round = 0; round < rounds; ++round) {
    std::atomic<unsigned> ready{0};
    std::atomic<std::uint64_t> total{0};
    std::atomic<double> start{0};
    const auto read = [&](unsigned thread) {
      if (++ready == threads) start = wall_milliseconds();
      while (ready < threads) std::this_thread::yield();
      std::uint64_t sum = 0;
      for (std::size_t i = 0; i < repetitions; ++i) {
        sum += sum_of(arrays[thread]);
        std::atomic_signal_fence(std::memory_order_seq_cst);  // forces the compiler to read the memory again
      }
      total += sum;
    };
    std::vector<std::thread> helpers;
    for (unsigned thread = 1; thread < threads; ++thread) helpers.emplace_back(read, thread);
    read(0);
    for (std::thread& helper : helpers) helper.join();
    const double milliseconds = wall_milliseconds() - start;
    const auto gigabytes = static_cast<double>(words * threads * sizeof(std::uint64_t) * repetitions) * 1e-9;
    if (total != 0) best = std::max(best, 1e3 * gigabytes / milliseconds);
  }
  return best;
}

IdealRefit::IdealRefit(const TriangleMesh& mesh, std::size_t per_slot) : per_slot_(per_slot) {
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> number(mesh.positions.size(), none);
  for (const std::uint32_t triangle : morton_order(mesh)) {
    for (const std::uint32_t vertex : mesh.triangles[triangle]) {
      if (number[vertex] == none) {
        number[vertex] = static_cast<std::uint32_t>(positions_.size() / 3);
        for (int axis = 0; axis < 3; ++axis)
          positions_.push_back(static_cast<float>(mesh.positions[vertex][axis]));
      }
      indices_.push_back(number[vertex]);
    }
  }
  positions_.push_back(0);
  const std::size_t of_node = 3 * 8 * per_slot;
  while (indices_.size() % of_node != 0) indices_.push_back(indices_[indices_.size() - 3]);
  for (std::size_t nodes = indices_.size() / of_node;; nodes = (nodes + 7) / 8) {
    levels_.emplace_back(nodes);
    bounds_.emplace_back(nodes);
    if (nodes == 1) break;
  }
}

/// Writes eight boxes as the children of a node; `around` receives their union for the level above.
void IdealRefit::write_node(const Corners (&boxes)[8], Node& node, Bounds& around) {
  const hn::Full128<float> d;
  Corners all = boxes[0];
  for (int i = 1; i < 8; ++i) {
    all.low = hn::Min(all.low, boxes[i].low);
    all.high = hn::Max(all.high, boxes[i].high);
  }
  for (int half = 0; half < 8; half += 4) {
    for (const bool is_low : {true, false}) {
      const auto row = [&](int i) { return is_low ? boxes[half + i].low : boxes[half + i].high; };
      auto& lanes = is_low ? node.low : node.high;
      const auto xy_even = hn::InterleaveLower(d, row(0), row(2)),
                 xy_odd = hn::InterleaveLower(d, row(1), row(3));
      const auto z_even = hn::InterleaveUpper(d, row(0), row(2)),
                 z_odd = hn::InterleaveUpper(d, row(1), row(3));
      hn::Store(hn::InterleaveLower(d, xy_even, xy_odd), d, lanes[0] + half);
      hn::Store(hn::InterleaveUpper(d, xy_even, xy_odd), d, lanes[1] + half);
      hn::Store(hn::InterleaveLower(d, z_even, z_odd), d, lanes[2] + half);
    }
  }
  hn::Store(all.low, d, around.low);
  hn::Store(all.high, d, around.high);
}

template <class Count>
void IdealRefit::run_lowest(Count per_slot) {
  const hn::Full128<float> d;
  const std::uint32_t* index = indices_.data();
  for (std::size_t i = 0; i < levels_.front().size(); ++i) {
    Corners boxes[8];
    for (Corners& box : boxes) {
      box.low = box.high = hn::LoadU(d, &positions_[3 * std::size_t{index[0]}]);
      for (std::size_t corner = 1; corner < 3 * per_slot; ++corner) {
        const auto p = hn::LoadU(d, &positions_[3 * std::size_t{index[corner]}]);
        box.low = hn::Min(box.low, p);
        box.high = hn::Max(box.high, p);
      }
      index += 3 * per_slot;
    }
    write_node(boxes, levels_.front()[i], bounds_.front()[i]);
  }
}

void IdealRefit::run_level(std::size_t level) {
  const hn::Full128<float> d;
  const std::vector<Bounds>& children = bounds_[level - 1];
  for (std::size_t i = 0; i < levels_[level].size(); ++i) {
    Corners boxes[8];
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const Bounds& child = children[std::min(8 * i + lane, children.size() - 1)];
      boxes[lane] = {hn::Load(d, child.low), hn::Load(d, child.high)};
    }
    write_node(boxes, levels_[level][i], bounds_[level][i]);
  }
}

void IdealRefit::run() {
  if (per_slot_ == 1)
    run_lowest(std::integral_constant<std::size_t, 1>());
  else if (per_slot_ == 4)
    run_lowest(std::integral_constant<std::size_t, 4>());
  else
    run_lowest(per_slot_);
  for (std::size_t level = 1; level < levels_.size(); ++level) run_level(level);
}

Aabb IdealRefit::bounds() const {
  const auto& [low, high] = bounds_.back().front();
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

}  // namespace supple::benchmarks
