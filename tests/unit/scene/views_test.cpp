#include "supple/views.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstring>
#include <deque>
#include <string>
#include <type_traits>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/scenes.hpp"

namespace supple::views_test {

const std::vector<Vec3d> four_points{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};

std::vector<Vec3d> points_of(const PositionsView& view) {
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < view.size(); ++i) points.push_back(view[i]);
  return points;
}

template <class Matrix>
Matrix in_rows() {
  Matrix matrix(4, 3);
  for (int i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      matrix(i, axis) = static_cast<typename Matrix::Scalar>(four_points[static_cast<std::size_t>(i)][axis]);
  }
  return matrix;
}

TEST(PositionsViews, ReadRangesOfPoints) {
  EXPECT_EQ(points_of(four_points), four_points);
  EXPECT_EQ(points_of(std::span(four_points).first(2)), (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(points_of(std::vector<Vec3f>{{1, 2, 3}}), (std::vector<Vec3d>{{1, 2, 3}}));
  EXPECT_EQ(points_of(std::vector<std::array<float, 3>>{{1, 2, 3}}), (std::vector<Vec3d>{{1, 2, 3}}));
  EXPECT_EQ(points_of(std::vector<Eigen::Vector3d>{{1, 2, 3}, {4, 5, 6}}),
            (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(points_of(std::vector<double>{1, 2, 3, 4, 5, 6}), (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 6}}));
  const float packed[] = {1, 2, 3};
  EXPECT_EQ(points_of(packed), (std::vector<Vec3d>{{1, 2, 3}}));
  EXPECT_EQ(points_of(std::vector<double>{}), std::vector<Vec3d>{});
  EXPECT_EQ(points_of(PositionsView()), std::vector<Vec3d>{});
  EXPECT_THROW(PositionsView(std::vector<double>(10)), Error);
  static_assert(!std::is_convertible_v<std::deque<Vec3d>, PositionsView>);
  static_assert(!std::is_convertible_v<std::vector<int>, PositionsView>);
  static_assert(!std::is_convertible_v<std::vector<Triangle>, PositionsView>);
  static_assert(!std::is_convertible_v<Eigen::MatrixXi, PositionsView>);
}

TEST(PositionsViews, ReadMatricesOfAnyLayout) {
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto columns = in_rows<Eigen::MatrixXd>();
  EXPECT_EQ(points_of(columns), four_points);
  EXPECT_EQ(PositionsView(columns).coordinate_stride(), std::ptrdiff_t{4 * sizeof(double)});
  EXPECT_EQ(points_of(in_rows<Eigen::MatrixX3d>()), four_points);
  EXPECT_EQ(points_of(in_rows<RowMajor>()), four_points);
  EXPECT_EQ(points_of(in_rows<Eigen::ArrayXXf>()), four_points);
  const Eigen::MatrixXd transposed = columns.transpose();
  EXPECT_EQ(points_of(transposed), four_points);
  EXPECT_EQ(PositionsView(transposed).data(), transposed.data());
  EXPECT_EQ(points_of(Eigen::Matrix3Xd(transposed)), four_points);
  EXPECT_EQ(points_of(columns.transpose()), four_points);
  // Blocks of a larger matrix.
  Eigen::MatrixXd larger = Eigen::MatrixXd::Random(9, 7);
  larger.block(2, 3, 4, 3) = columns;
  EXPECT_EQ(points_of(larger.block(2, 3, 4, 3)), four_points);
  EXPECT_EQ(points_of(larger.middleRows(2, 4).middleCols(3, 3)), four_points);
  const Eigen::Ref<const Eigen::MatrixXd> reference = larger.block(2, 3, 4, 3);
  EXPECT_EQ(points_of(reference), four_points);
  using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
  std::vector<double> spread(100);
  Eigen::Map<Eigen::MatrixXd, 0, Stride> map(spread.data(), 4, 3, Stride(30, 7));
  map = columns;
  EXPECT_EQ(points_of(map), four_points);
  // Packed x y z, as in many solvers.
  Eigen::VectorXd packed(12);
  for (int i = 0; i < 12; ++i) packed[i] = four_points[static_cast<std::size_t>(i / 3)][i % 3];
  EXPECT_EQ(points_of(packed), four_points);
  EXPECT_EQ(points_of(packed.segment(3, 6)), (std::vector<Vec3d>{{4, 5, 6}, {7, 8, 9}}));
  EXPECT_EQ(points_of(Eigen::MatrixXd(columns.topRows(1))), (std::vector<Vec3d>{{1, 2, 3}}));
  EXPECT_EQ(points_of(Eigen::MatrixXd(transposed.leftCols(1))), (std::vector<Vec3d>{{1, 2, 3}}));
  EXPECT_EQ(points_of(Eigen::MatrixXd(0, 3)), std::vector<Vec3d>{});
  EXPECT_EQ(points_of(Eigen::MatrixXd(3, 0)), std::vector<Vec3d>{});
  EXPECT_EQ(points_of(Eigen::MatrixXd()), std::vector<Vec3d>{});
}

TEST(PositionsViews, RefuseMatricesThatCouldBeTwoThings) {
  const Eigen::MatrixXd square = in_rows<Eigen::MatrixXd>().topRows(3);
  EXPECT_THROW(PositionsView{square}, Error);
  EXPECT_THROW(PositionsView{Eigen::Matrix3d::Zero().eval()}, Error);
  const std::vector<Vec3d> rows(four_points.begin(), four_points.begin() + 3);
  EXPECT_EQ(points_of({square, MatrixItems::rows}), rows);
  EXPECT_EQ(points_of({square, MatrixItems::columns}), (std::vector<Vec3d>{{1, 4, 7}, {2, 5, 8}, {3, 6, 9}}));
  EXPECT_EQ(points_of(Eigen::MatrixX3d(square)), rows);
  EXPECT_EQ(points_of(Eigen::Matrix3Xd(square.transpose())), rows);
  EXPECT_THROW(PositionsView{Eigen::MatrixXd(4, 5)}, Error);
  EXPECT_THROW(PositionsView{Eigen::VectorXd(10)}, Error);
  EXPECT_THROW(PositionsView(Eigen::MatrixXd(4, 3), MatrixItems::columns), Error);
  EXPECT_THROW(PositionsView(Eigen::VectorXd(6), MatrixItems::rows), Error);
}

TEST(PositionsViews, ReadUnalignedAndBackwards) {
  std::vector<char> bytes(1 + 4 * 29);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d& p = four_points[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::memcpy(bytes.data() + 1 + 29 * i + 9 * axis, &p[static_cast<int>(axis)], sizeof(double));
  }
  const void* const first = bytes.data() + 1;
  EXPECT_EQ(points_of(PositionsView(static_cast<const double*>(first), 4, 29, 9)), four_points);
  const std::vector<Vec3d> backwards(four_points.rbegin(), four_points.rend());
  EXPECT_EQ(points_of(PositionsView(&four_points[3].x, 4, -24)), backwards);
  EXPECT_EQ(points_of(PositionsView(&four_points[0].x, 3, 0)), std::vector<Vec3d>(3, four_points[0]));
}

TEST(TrianglesViews, ReadAllKindsOfIds) {
  using Ids = std::array<std::int64_t, 3>;
  const auto second = [](const TrianglesView& view) {
    EXPECT_EQ(view.size(), 2u);
    return view[1];
  };
  const Ids expected{3, 4, 5};
  EXPECT_EQ(second(std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}), expected);
  EXPECT_EQ(second(std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<long>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<long long>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<std::size_t>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<unsigned long long>{0, 1, 2, 3, 4, 5}), expected);
  EXPECT_EQ(second(std::vector<std::array<std::uint16_t, 3>>{{0, 1, 2}, {3, 4, 5}}), expected);
  EXPECT_EQ(second(std::vector<std::int32_t>{0, 1, 2, -3, -4, -5}), (Ids{-3, -4, -5}));
  EXPECT_EQ(second(std::vector<std::uint32_t>{0, 1, 2, ~0u, 4, 5}), (Ids{0xffffffff, 4, 5}));
  EXPECT_EQ(second(std::vector<std::uint16_t>{0, 1, 2, 0xffff, 4, 5}), (Ids{0xffff, 4, 5}));
  Eigen::MatrixXi columns(2, 3);
  columns << 0, 1, 2, 3, 4, 5;
  EXPECT_EQ(second(columns), expected);
  EXPECT_EQ(second(Eigen::MatrixXi(columns.transpose())), expected);
  EXPECT_EQ(second(Eigen::Matrix<long long, Eigen::Dynamic, 3>(columns.cast<long long>())), expected);
  EXPECT_EQ(second(Eigen::Matrix<Eigen::Index, 3, Eigen::Dynamic>(columns.transpose().cast<Eigen::Index>())),
            expected);
  const std::uint16_t strided[] = {0, 9, 1, 9, 2, 9, 9, 3, 9, 4, 9, 5, 9, 9};
  EXPECT_EQ(second(TrianglesView(strided, 2, 14, 4)), expected);
  EXPECT_THROW(TrianglesView(std::vector<int>(4)), Error);
}

TEST(TrianglesViews, WrongIdsAreErrorsThatNameThem) {
  const auto message = [](const TrianglesView& triangles) {
    Scene scene;
    try {
      scene.add(four_points, triangles, {.name = "net"});
    } catch (const Error& error) {
      EXPECT_TRUE(scene.objects().empty());
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(std::vector<int>{0, 1, 2, 1, 2, 3}), "");
  EXPECT_EQ(message(std::vector<int>{0, 1, 2, 1, -2, 3}),
            "net: triangle 1 uses vertex -2, but there are 4 vertices, numbered from 0");
  EXPECT_EQ(message(std::vector<std::uint16_t>{0, 1, 4}),
            "net: triangle 0 uses vertex 4, but there are 4 vertices, numbered from 0");
  EXPECT_EQ(message(std::vector<std::int64_t>{0, 1, std::int64_t{1} << 32}),
            "net: triangle 0 uses vertex 4294967296, but there are 4 vertices, numbered from 0");
  EXPECT_EQ(message(std::vector<unsigned long long>{0, 1, ~0ull}),
            "net: triangle 0 uses vertex -1, but there are 4 vertices, numbered from 0");
}

Eigen::MatrixXd matrix_of(const std::vector<Vec3d>& points, double shift) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    matrix.row(static_cast<Eigen::Index>(i)) << points[i].x + shift, points[i].y, points[i].z;
  return matrix;
}

TEST(SceneViews, AnyLayoutGivesTheSameContacts) {
  const TriangleMesh ball = make_icosphere(6);
  Eigen::MatrixXi faces(static_cast<Eigen::Index>(ball.triangles.size()), 3);
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      faces(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(corner)) =
          static_cast<int>(ball.triangles[t][corner]);
  }
  Scene expected;
  expected.add(ball);
  const ObjectId other = expected.add(ball);
  std::vector<Vec3d> shifted = ball.positions;
  for (Vec3d& p : shifted) p.x += 1.25;
  expected.set_positions(other, shifted);
  const std::uint64_t hash = hash_of(expected.detect());
  ASSERT_GT(expected.result().contacts.size(), 0u);

  const Eigen::MatrixXd in_rows = matrix_of(ball.positions, 1.25), in_columns = in_rows.transpose();
  for (const Eigen::MatrixXd& matrix : {in_rows, in_columns}) {
    for (const bool share : {false, true}) {
      Scene scene;
      scene.add(ball);
      const ObjectId id = scene.add(matrix_of(ball.positions, 0), faces);
      if (share) {
        scene.share_positions(id, matrix);
      } else {
        scene.set_positions(id, matrix);
      }
      EXPECT_EQ(hash_of(scene.detect()), hash);
    }
  }
}

TEST(SceneViews, ColumnsAreSharedAndRowsOfColumnMajorMatricesAreCopied) {
  const TriangleMesh ball = make_icosphere(3);
  Eigen::MatrixXd in_rows = matrix_of(ball.positions, 0), in_columns = in_rows.transpose();
  Scene scene;
  const ObjectId shared = scene.add(ball), copied = scene.add(ball);
  scene.share_positions(shared, in_columns);
  scene.share_positions(copied, in_rows);
  const double was = in_rows(0, 0);
  in_columns(0, 0) = in_rows(0, 0) = 17;
  EXPECT_EQ(scene.position(shared, 0).x, 17);
  EXPECT_EQ(scene.position(copied, 0).x, was);
}

TEST(SceneViews, BothEndsOfAPathHaveOnePrecision) {
  const TriangleMesh ball = make_icosphere(2);
  Scene scene({.contacts = ContactKinds::continuous});
  const ObjectId id = scene.add(ball);
  const Eigen::MatrixXd from = matrix_of(ball.positions, 0), to = matrix_of(ball.positions, 1);
  scene.set_motion(id, from, to);
  scene.set_motion(id, Eigen::MatrixXf(from.cast<float>()), Eigen::MatrixXf(to.cast<float>()));
  EXPECT_THROW(scene.set_motion(id, from, Eigen::MatrixXf(to.cast<float>())), Error);
}

TEST(VerticesOf, ContactsAreTheCornersThatTheUserGave) {
  const TriangleMesh ball = make_icosphere(8);
  Scene scene;
  scene.add(ball);
  const ObjectId other = scene.add(ball);
  scene.translate(other, {1.5, 0.25, 0});
  ASSERT_GT(scene.detect().contacts.size(), 0u);
  const auto same = [](const ElementVertices& vertices, const Triangle& triangle) {
    return vertices.size() == 3 && std::equal(vertices.begin(), vertices.end(), triangle.begin());
  };
  for (const Contact& c : scene.result().contacts) {
    EXPECT_TRUE(same(scene.vertices_of(c, ContactSide::a), ball.triangles[c.triangle_a]));
    EXPECT_TRUE(same(scene.vertices_of(c, ContactSide::b), ball.triangles[c.triangle_b]));
  }
  Contact stale = scene.result().contacts.front();
  stale.triangle_b = static_cast<std::uint32_t>(ball.triangles.size());
  EXPECT_THROW(scene.vertices_of(stale, ContactSide::b), Error);
  scene.remove(other);
  EXPECT_THROW(scene.vertices_of(stale, ContactSide::b), Error);
}

TEST(VerticesOf, ContinuousContactsAreWeightedByTheirBarycentricCoordinates) {
  const TriangleMesh ball = make_icosphere(5);
  Scene scene({.contacts = ContactKinds::continuous});
  scene.add(ball, {.is_static = true});
  const ObjectId other = scene.add(ball);
  std::vector<Vec3d> from = ball.positions, to = ball.positions;
  for (Vec3d& p : from) p += Vec3d{3, 0.25, 0.125};
  for (Vec3d& p : to) p += Vec3d{1.5, 0.125, 0.25};
  scene.set_motion(other, from, to);
  bool kinds[3] = {};
  for (const ContinuousContact& c : scene.detect().continuous_contacts) {
    kinds[static_cast<int>(c.kind)] = true;
    const ElementVertices a = scene.vertices_of(c, ContactSide::a), b = scene.vertices_of(c, ContactSide::b);
    EXPECT_EQ(a.size() + b.size(), 4u);
    Vec3d on_a{}, on_b{};
    for (std::size_t i = 0; i < a.size(); ++i) on_a += c.barycentric_a[i] * ball.positions[a[i]];
    for (std::size_t i = 0; i < b.size(); ++i)
      on_b += c.barycentric_b[i] * ((1 - c.toi) * from[b[i]] + c.toi * to[b[i]]);
    EXPECT_LT(norm(on_a - c.point), 1e-7);
    EXPECT_LT(norm(on_b - c.point), 1e-7);
  }
  EXPECT_TRUE(kinds[0] && kinds[1] && kinds[2]);
}

}  // namespace supple::views_test
