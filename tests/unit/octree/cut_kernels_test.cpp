#include "octree/build/cut_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "support/instruction_sets.hpp"
#include "support/random.hpp"

namespace supple::cut_kernels_test {

/// Points between others, which the kernels must not change.
class Points {
 public:
  Points(std::size_t count, RandomNumbers& random) : count_(count), triangles_(count + 2 * margin) {
    for (auto& coordinates : at_) {
      coordinates.resize(triangles_.size());
      for (float& c : coordinates)
        c = random.below(8) == 0 ? 0.25f : static_cast<float>(random.uniform(-1, 1));
    }
    std::iota(triangles_.begin(), triangles_.end(), 0u);
  }

  PointArrays arrays() {
    return PointArrays{{at_[0].data(), at_[1].data(), at_[2].data()}, triangles_.data()}.from(margin);
  }
  std::size_t size() const { return count_; }

  /// Coordinates and triangle of a point, counted from the first one that is between others.
  using Point = std::array<float, 4>;
  Point point(std::size_t i) const {
    return {at_[0][i], at_[1][i], at_[2][i], static_cast<float>(triangles_[i])};
  }
  std::vector<Point> all() const {
    std::vector<Point> points;
    for (std::size_t i = 0; i < triangles_.size(); ++i) points.push_back(point(i));
    return points;
  }

  static constexpr std::size_t margin = 20;

 private:
  std::size_t count_;
  std::array<std::vector<float>, 3> at_;
  std::vector<std::uint32_t> triangles_;
};

TEST(CutKernels, FindTheBox) {
  for_each_target([](const char* name) {
    RandomNumbers random(1);
    for (std::size_t count = 1; count < 70; ++count) {
      Points points(count, random);
      const PointBox box = box_of_points(points.arrays(), count);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* const at = points.arrays().at[axis];
        EXPECT_EQ(box.low[axis], *std::min_element(at, at + count)) << name;
        EXPECT_EQ(box.high[axis], *std::max_element(at, at + count)) << name;
      }
    }
  });
}

TEST(CutKernels, NumberTheCells) {
  for_each_target([](const char* name) {
    RandomNumbers random(2);
    for (std::size_t count = 1; count < 70; ++count) {
      for (const std::uint32_t cells : {4u, 64u, 1024u, 65536u}) {
        Points points(count, random);
        const float* const at = points.arrays().at[1];
        const auto [low, high] = std::minmax_element(at, at + count);
        const float scale = static_cast<float>(cells) / (*high - *low);
        if (!(scale < std::numeric_limits<float>::infinity())) continue;
        std::vector<std::uint16_t> numbers(count + 1, 7);
        number_cells(at, count, *low, scale, cells, numbers.data());
        for (std::size_t i = 0; i < count; ++i) {
          const auto expected = std::min(static_cast<std::uint32_t>((at[i] - *low) * scale), cells - 1);
          EXPECT_EQ(numbers[i], expected) << name;
        }
        EXPECT_EQ(numbers[count], 7) << name;
      }
    }
  });
}

TEST(CutKernels, PartitionInOrder) {
  for_each_target([](const char* name) {
    RandomNumbers random(3);
    for (std::size_t count = 1; count < 200; ++count) {
      Points points(count, random), upper(count + points_ahead, random);
      std::vector<std::uint16_t> cells(count);
      for (std::uint16_t& cell : cells) cell = static_cast<std::uint16_t>(random.below(5));
      const std::uint32_t border = random.below(6);
      const std::vector<Points::Point> before = points.all();
      std::vector<Points::Point> expected = before;
      std::size_t end = Points::margin;
      for (const bool lower : {true, false}) {
        for (std::size_t i = 0; i < count; ++i) {
          if ((cells[i] < border) == lower) expected[end++] = before[Points::margin + i];
        }
      }
      const auto lower = static_cast<std::uint32_t>(
          std::count_if(cells.begin(), cells.end(), [&](std::uint16_t cell) { return cell < border; }));
      EXPECT_EQ(partition_points(points.arrays(), count, cells.data(), border, upper.arrays()), lower);
      EXPECT_EQ(points.all(), expected) << name << ", " << count;
    }
  });
}

}  // namespace supple::cut_kernels_test
