// Compares the kernels with the scalar functions, for every instruction set.

#include "contact/distance/distance_kernels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "contact/distance/edge_face_crossing.hpp"
#include "support/instruction_sets.hpp"
#include "support/random.hpp"

namespace supple::distance_kernels_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Pairs of elements of one kind, of all sizes: random, on a lattice (so that edges are parallel, features
/// touch and triangles have no area), nearly coplanar, and far from the origin.
class AnyElements {
 public:
  explicit AnyElements(std::uint64_t seed) : random_(seed) {}

  ElementPoints next(bool are_edges) {
    ElementPoints elements;
    elements.count_a = are_edges ? 2 : 1;
    elements.count_b = are_edges ? 2 : 3;
    const std::uint32_t what = random_.below(8);
    const double scale = std::ldexp(1.0, what == 7 ? random_.between(-1000, 1000) : random_.between(-30, 30));
    const Vec3d far = what == 6 ? scale * 1e5 * point() : Vec3d{};
    for (Vec3d& p : elements.points) {
      p = point();
      if (what < 2) p = {std::floor(3 * p.x), std::floor(3 * p.y), std::floor(3 * p.z)};
      if (what == 2) p.z *= 0x1p-30;
      if (what == 3) p.z = 0.1 * p.z + (&p - elements.points.data() < elements.count_a ? 0.5 : 0);
      p = scale * p + far;
    }
    if (what == 4) elements.points[3] = elements.points[2] + (elements.points[1] - elements.points[0]);
    return elements;
  }
  double number() { return random_.uniform(0, 1); }
  std::uint32_t below(std::uint32_t count) { return random_.below(count); }

 private:
  Vec3d point() { return random_.vector(0.5); }

  RandomNumbers random_;
};

struct Block {
  std::array<ElementPoints, PointsBlock::capacity> elements;
  PointsBlock points;
};

Block any_block(AnyElements& any, bool are_edges) {
  Block block;
  for (std::size_t k = 0; k < block.elements.size(); ++k) {
    block.elements[k] = any.next(are_edges);
    for (std::size_t i = 0; i < 4; ++i) block.points.set(i, k, block.elements[k].points[i]);
  }
  return block;
}

TEST(DistanceKernels, ClassifyAgreesWithTheExactFeatures) {
  for (const bool are_edges : {false, true}) {
    AnyElements any(are_edges ? 1 : 2);
    std::size_t known = 0, near = 0, total = 0;
    std::vector<std::size_t> by_code(16, 0);
    for (int round = 0; round < 300; ++round) {
      const Block block = any_block(any, are_edges);
      // A distance near that of one of the pairs.
      bool used_exact = false;
      const ElementPoints& some = block.elements[any.below(64)];
      const double of_some = distance_within(some, infinity, used_exact)->distance;
      const double reach = round % 10 == 0   ? 0
                           : round % 10 == 1 ? infinity
                           : round % 10 == 2 ? of_some
                                             : of_some * (0.5 + any.number());
      const std::size_t count = round % 5 == 0 ? 1 + any.below(64) : 64;
      std::optional<std::array<FeatureCode, 64>> first;
      for_each_target([&](const char* target) {
        std::array<FeatureCode, 64> codes;
        codes.fill(FeatureCode::unknown);
        classify(block.points, count, are_edges, reach, codes.data());
        if (!first) first = codes;
        EXPECT_TRUE(codes == *first) << target;
      });
      for (std::size_t k = 0; k < count; ++k) {
        ++total;
        const FeatureCode code = (*first)[k];
        if (code == FeatureCode::unknown) continue;
        ++known;
        const auto expected = closest_features_within(block.elements[k], reach, used_exact);
        ASSERT_EQ(code == FeatureCode::apart, !expected.has_value());
        if (!expected) continue;
        ++near;
        ++by_code[static_cast<std::size_t>(code)];
        const ClosestFeatures found = features_of_code(code, are_edges);
        ASSERT_TRUE(found == *expected) << static_cast<int>(code);
      }
    }
    EXPECT_GT(known, total / 2);
    EXPECT_GT(near, total / 8);
    for (std::size_t code = 0; code < (are_edges ? 9u : 7u); ++code) EXPECT_GT(by_code[code], 20u) << code;
  }
}

TEST(DistanceKernels, ClassifyDecidesOrdinaryElementsAndParallelEdgesThatAreApart) {
  AnyElements any(3);
  for (const bool are_edges : {false, true}) {
    PointsBlock points;
    for (std::size_t k = 0; k < 64; ++k) {
      for (std::size_t i = 0; i < 4; ++i) points.set(i, k, {any.number(), any.number(), any.number()});
      if (k % 2 == 0) continue;
      // Two parallel edges side by side, or a vertex beside a triangle without area.
      for (std::size_t i = 0; i < 4; ++i)
        points.set(i, k,
                   {0.25 * static_cast<double>(i % 2 + i / 3),
                    are_edges ? (i < 2 ? 0.0 : 1.0) : (i == 0 ? 0.0 : 1.0), 0.5});
    }
    std::array<FeatureCode, 64> codes;
    classify(points, 64, are_edges, 0.3, codes.data());
    for (std::size_t k = 0; k < 64; ++k) {
      EXPECT_NE(codes[k], FeatureCode::unknown) << k;
      if (k % 2 == 1) {
        EXPECT_EQ(codes[k], FeatureCode::apart) << k;
      }
    }
  }
}

TEST(DistanceKernels, CrossingsAgreeWithTheExactTest) {
  AnyElements any(4);
  std::size_t unknown = 0, crossing = 0, total = 0;
  for (int round = 0; round < 600; ++round) {
    PointsBlock block;
    std::array<std::array<Vec3d, 5>, 64> points;
    for (std::size_t k = 0; k < 64; ++k) {
      const std::array<Vec3d, 4> p = any.next(k % 2 == 0).points;
      // A fifth point anywhere, on the edge, in the plane of the edge and a corner, or equal to another one.
      const double part = any.below(4) == 0 ? 0 : any.number();
      points[k] = {p[0], p[1], p[2], p[3], p[any.below(4)] + part * (p[any.below(4)] - p[any.below(4)])};
      if (any.below(2) == 0) std::swap(points[k][any.below(4)], points[k][4]);
      for (std::size_t i = 0; i < 5; ++i) block.set(i, k, points[k][i]);
    }
    for_each_target([&](const char* target) {
      std::array<FeatureCode, 64> codes;
      classify_crossings(block, 64, codes.data());
      for (std::size_t k = 0; k < 64; ++k, ++total) {
        const auto& [first, last, a, b, c] = points[k];
        bool used_exact = false;
        if (codes[k] == FeatureCode::unknown)
          ++unknown;
        else
          ASSERT_EQ(codes[k] == FeatureCode::crosses, edge_crosses_face({first, last}, {a, b, c}, used_exact))
              << target;
        crossing += codes[k] == FeatureCode::crosses;
      }
    });
  }
  EXPECT_GT(crossing, total / 400);
  EXPECT_LT(unknown, total * 2 / 3);
}

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Whether two results are equal, with the signs of zeros.
bool same_bits(const ElementDistance& a, const ElementDistance& b) {
  bool same = same_bits(a.distance, b.distance) && a.on_a == b.on_a && a.on_b == b.on_b;
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    same = same && same_bits(a.barycentric_a[i], b.barycentric_a[i]) &&
           same_bits(a.barycentric_b[i], b.barycentric_b[i]) && same_bits(a.point_a[axis], b.point_a[axis]) &&
           same_bits(a.point_b[axis], b.point_b[axis]) && same_bits(a.normal[axis], b.normal[axis]);
  }
  return same;
}

TEST(DistanceKernels, NumbersHaveTheBitsOfTheScalarFunction) {
  AnyElements any(4);
  std::array<std::size_t, 4> valid{}, used{};
  for (int round = 0; round < 400; ++round) {
    const bool are_edges = round % 2 == 0;
    const Block block = any_block(any, are_edges);
    std::array<ClosestFeatures, 64> features;
    for (std::size_t k = 0; k < 64; ++k) {
      bool used_exact = false;
      features[k] = *closest_features_within(block.elements[k], infinity, used_exact);
    }
    for (const FeaturePair kind :
         {FeaturePair::vertices, FeaturePair::vertex_edge, FeaturePair::vertex_face, FeaturePair::edges}) {
      PointsBlock points;
      std::vector<std::size_t> members;
      for (std::size_t k = 0; k < 64; ++k) {
        using Kind = ClosestFeatures::Kind;
        const ClosestFeatures& f = features[k];
        const FeaturePair own = f.kind == Kind::vertices      ? FeaturePair::vertices
                                : f.kind == Kind::vertex_edge ? FeaturePair::vertex_edge
                                : are_edges                   ? FeaturePair::edges
                                                              : FeaturePair::vertex_face;
        if (own != kind) continue;
        const bool is_whole = f.kind == Kind::interiors;
        const std::array<std::size_t, 4> from{is_whole ? 0u : f.vertex, is_whole ? 1u : f.edge[0],
                                              is_whole ? 2u : f.edge[1], 3u};
        for (std::size_t i = 0; i < 4; ++i) points.set(i, members.size(), block.elements[k].points[from[i]]);
        members.push_back(k);
      }
      for_each_target([&](const char* target) {
        DistanceNumbersBlock numbers;
        compute_distance_numbers(points, members.size(), kind, DistanceAccuracy::full, numbers);
        for (std::size_t m = 0; m < members.size(); ++m) {
          const ElementPoints& elements = block.elements[members[m]];
          bool used_exact = false;
          const ElementDistance expected = distance_of(elements, features[members[m]], used_exact);
          ++used[static_cast<std::size_t>(kind)];
          ASSERT_FALSE(numbers.is_valid[m] != 0 && used_exact) << target;
          if (numbers.is_valid[m] == 0) continue;
          ++valid[static_cast<std::size_t>(kind)];
          ASSERT_TRUE(same_bits(distance_of(elements, features[members[m]], numbers.at(m)), expected))
              << target << ", kind " << static_cast<int>(kind);
        }
      });
    }
  }
  for (std::size_t kind = 0; kind < 4; ++kind) {
    EXPECT_GT(valid[kind], used[kind] / 2) << kind;
    EXPECT_GT(valid[kind], 500u) << kind;
  }
}

}  // namespace supple::distance_kernels_test
