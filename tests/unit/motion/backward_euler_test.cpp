// Tests the linear systems of backward Euler and their solvers.

#include "motion/implicit/backward_euler.hpp"

#include <gtest/gtest.h>

#include "core/parallel.hpp"
#include "motion/mass_spring.hpp"
#include "supple/error.hpp"
#include "support/bodies.hpp"

namespace supple::backward_euler_test {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// With stiff springs the solver uses a sparse factorization, otherwise conjugate gradients.
MassSpringOptions implicit_options(double stiffness) {
  return {.integrator = Integrator::backward_euler,
          .stiffness = stiffness,
          .bending_stiffness = 0.2 * stiffness,
          .area_stiffness = 0.5 * stiffness,
          .gravity = {0, -10, 0},
          .fixed_vertices = {0, 5}};
}

std::vector<Vec3d> state_of(const MassSpring& body) {
  std::vector<Vec3d> state(body.positions().begin(), body.positions().end());
  state.insert(state.end(), body.velocities().begin(), body.velocities().end());
  return state;
}

TEST(BackwardEulerSteps, AreTheSameForAnyNumberOfThreads) {
  // The cloth has more than two chunks of vertices.
  const TriangleMesh cloth = make_cloth(36, 36, 3.6, 3.6);
  for (const double stiffness : {100.0, 1e8}) {
    std::vector<Vec3d> expected;
    for (std::uint32_t threads = 1; threads <= 5; ++threads) {
      const Parallel parallel(threads);
      MassSpring body(cloth, implicit_options(stiffness));
      body.set_positions(deformed(cloth, 0.05, 0.002, 31));
      for (int i = 0; i < 2; ++i) ASSERT_EQ(body.try_step(0.01, parallel), std::nullopt);
      if (threads == 1) expected = state_of(body);
      EXPECT_EQ(state_of(body), expected) << threads << " threads, stiffness " << stiffness;
    }
  }
}

TEST(BackwardEulerSteps, DependOnNoStepBefore) {
  const TriangleMesh cloth = make_cloth(12, 12);
  for (const double stiffness : {100.0, 1e8}) {
    MassSpringBody travelled(cloth, implicit_options(stiffness)), fresh(cloth, implicit_options(stiffness));
    travelled.set_positions(deformed(cloth, 0.1, 0.01, 32));
    for (int i = 0; i < 5; ++i) travelled.step(0.01);
    fresh.set_positions(travelled.positions());
    fresh.set_velocities(travelled.velocities());
    travelled.step(0.01);
    const std::vector<Vec3d> first(travelled.positions().begin(), travelled.positions().end());
    travelled.undo_step();
    travelled.step(0.01);
    fresh.step(0.01);
    EXPECT_EQ(largest_difference(travelled.positions(), first), 0) << stiffness;
    EXPECT_EQ(largest_difference(fresh.positions(), first), 0) << stiffness;
  }
}

TEST(BackwardEulerSteps, BearAnyConditionNumber) {
  const TriangleMesh cloth = make_cloth(8, 8);
  for (const double stiffness : {1e4, 1e8, 1e12, 1e16}) {
    MassSpringBody body(cloth, {.integrator = Integrator::backward_euler,
                                .stiffness = stiffness,
                                .damping = 0,
                                .fixed_vertices = {0}});
    body.set_positions(deformed(cloth, 0.2, 0.01, 33));
    const double at_first = body.energy().total();
    for (int i = 0; i < 30; ++i) {
      body.step(0.1);
      EXPECT_LE(body.energy().total(), at_first) << stiffness;
    }
    EXPECT_LT(body.energy().total(), 0.05 * at_first) << stiffness;
  }
}

TEST(BackwardEulerSteps, WithoutStiffnessAreFreeFall) {
  const TriangleMesh mesh = make_icosphere(1);
  MassSpringBody body(mesh, {.integrator = Integrator::backward_euler,
                             .stiffness = 0,
                             .damping = 0,
                             .gravity = {0, -8, 0},
                             .fixed_vertices = {3}});
  for (int i = 0; i < 4; ++i) body.step(0.25);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    // Each step moves with its end velocity, so the distance is 8 h² (1 + 2 + 3 + 4).
    const Vec3d way = body.positions()[v] - mesh.positions[v];
    EXPECT_NEAR(way.y, v == 3 ? 0 : -5, 1e-14);
    EXPECT_EQ(way.x, 0);
  }
}

TEST(BackwardEulerSteps, OfOneVertexAndOfNoneThatIsFree) {
  const MassSpringOptions options{
      .integrator = Integrator::backward_euler, .vertex_mass = 2, .air_friction = 4, .gravity = {0, -10, 0}};
  MassSpringBody one({"point", {{1, 2, 3}}, {}}, options);
  one.step(0.5);
  // v (m + h friction) = -10 h m
  EXPECT_NEAR(one.velocities()[0].y, -2.5, 1e-15);
  EXPECT_NEAR(one.positions()[0].y, 0.75, 1e-15);

  MassSpringOptions held = options;
  held.fixed_vertices = {0, 1, 2};
  MassSpringBody triangle({"triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, held);
  triangle.set_velocities(std::vector<Vec3d>(3, Vec3d{1, 0, 0}));
  triangle.step(0.5);
  EXPECT_EQ(triangle.positions()[1], (Vec3d{1.5, 0, 0}));
}

struct Equations {
  MassSpringOptions options{.integrator = Integrator::backward_euler,
                            .vertex_mass = 0.7,
                            .stiffness = 30,
                            .damping = 2,
                            .air_friction = 0.4,
                            .bending_stiffness = 5,
                            .area_stiffness = 20,
                            .volume_stiffness = 15,
                            .gravity = {0, -10, 0}};
  TriangleMesh mesh = two_spheres();
  SpringNetwork network = build_spring_network(mesh, options, closed_parts(mesh));
  std::vector<VertexKind> kinds;
  std::vector<Vec3d> positions, velocities, at;
  StepEquations equations;
  Parallel parallel{1};

  Equations()
      : kinds(free_but_two(mesh.positions.size())),
        // The springs are stretched, so no term of the second derivative is omitted.
        positions(deformed(mesh, 0, 0.01, 41)),
        velocities(random_vectors(mesh.positions.size(), 0.1, 42)),
        at(random_vectors(mesh.positions.size(), 0.1, 43)),
        equations(network, kinds, options) {
    for (Vec3d& p : positions) p = p * 1.3;
  }

  static TriangleMesh two_spheres() {
    TriangleMesh mesh = make_icosphere(2);
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t v = 0; v < count; ++v) mesh.positions.push_back(mesh.positions[v] + Vec3d{4, 0, 0});
    const std::vector<Triangle> triangles = mesh.triangles;
    for (const Triangle& t : triangles) mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    return mesh;
  }
  static std::vector<VertexKind> free_but_two(std::size_t count) {
    std::vector<VertexKind> kinds(count, VertexKind::free);
    kinds[3] = kinds[17] = VertexKind::fixed;
    return kinds;
  }
  std::vector<Vec3d> random_free(std::uint64_t seed) const {
    std::vector<Vec3d> x = random_vectors(kinds.size(), 1, seed);
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (kinds[v] != VertexKind::free) x[v] = {};
    }
    return x;
  }
};

double product(std::span<const Vec3d> p, std::span<const Vec3d> q) {
  double sum = 0;
  for (std::size_t v = 0; v < p.size(); ++v) sum += dot(p[v], q[v]);
  return sum;
}

TEST(StepEquations, SlopeIsThatOfThePotential) {
  Equations e;
  const std::vector<Vec3d> forces = random_vectors(e.kinds.size(), 1, 44);
  const ImplicitStep step{e.network, e.positions, e.velocities, forces, {0.1, 0.2, 0.3}, 0.1};
  e.equations.begin(step, e.parallel);
  std::vector<Vec3d> descent(e.kinds.size());
  std::vector<SymmetricBlock> diagonal(e.kinds.size());
  e.equations.visit(e.at, e.parallel);
  e.equations.gather(e.at, descent, diagonal, e.parallel);
  const std::vector<Vec3d> direction = e.random_free(45);
  const auto potential_along = [&](double t) {
    std::vector<Vec3d> there = e.at;
    for (std::size_t v = 0; v < there.size(); ++v) there[v] = there[v] + direction[v] * t;
    return e.equations.visit(there, e.parallel);
  };
  const double slope = (potential_along(1e-5) - potential_along(-1e-5)) / 2e-5;
  EXPECT_NEAR(-product(descent, direction), slope, 1e-7 * std::abs(slope) + 1e-9);
}

TEST(StepEquations, ProductIsSymmetricAboveTheMassesAndWhatTheFactorUndoes) {
  Equations e;
  const ImplicitStep step{e.network, e.positions, e.velocities, {}, {}, 0.1};
  e.equations.begin(step, e.parallel);
  const std::size_t count = e.kinds.size();
  std::vector<Vec3d> descent(count), of_x(count), of_y(count);
  std::vector<SymmetricBlock> diagonal(count);
  e.equations.visit(e.at, e.parallel);
  e.equations.gather(e.at, descent, diagonal, e.parallel);
  const std::vector<Vec3d> x = e.random_free(46), y = e.random_free(47);
  const double square = e.equations.multiply(x, of_x, e.parallel);
  e.equations.multiply(y, of_y, e.parallel);
  EXPECT_NEAR(square, product(x, of_x), 1e-12 * square);
  EXPECT_NEAR(product(y, of_x), product(x, of_y), 1e-12 * square);
  EXPECT_GE(square, e.equations.smallest_diagonal() * product(x, x));

  SparseFactor factor = e.equations.make_factor();
  e.equations.fill(diagonal, factor);
  factor.factorise();
  const auto solve = [&](std::span<const Vec3d> right) {
    std::vector<Vec3d> rows, solution;
    for (std::size_t v = 0; v < count; ++v) {
      if (e.kinds[v] == VertexKind::free) rows.push_back(right[v]);
    }
    factor.solve(rows, rows);
    std::size_t row = 0;
    for (const VertexKind kind : e.kinds)
      solution.push_back(kind == VertexKind::free ? rows[row++] : Vec3d{});
    return solution;
  };
  std::vector<Vec3d> solution = solve(of_x);
  EXPECT_GT(largest_difference(solution, x), 1e-3);
  e.equations.keep_volumes(solve(e.equations.volume_gradient()), solution);
  EXPECT_LT(largest_difference(solution, x), 1e-12);
}

/// A graph of rows, and blocks such that the matrix is 1 + Σ of positive semidefinite ones.
struct Matrix {
  std::uint32_t count;
  Pairs pairs;
  std::vector<SymmetricBlock> blocks;

  Matrix(std::uint32_t rows, Pairs edges, std::uint64_t seed) : count(rows), pairs(std::move(edges)) {
    for (const Vec3d& n : random_vectors(pairs.size(), 3, seed))
      blocks.push_back(SymmetricBlock::outer(n, 1));
  }
  void fill(SparseFactor& factor) const {
    factor.set_zero();
    SymmetricBlock one;
    one.add_diagonal(1);
    for (std::uint32_t row = 0; row < count; ++row) factor.add_diagonal(row, one);
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
      for (const std::uint32_t row : pairs[i]) factor.add_diagonal(row, blocks[i]);
      factor.add(i, blocks[i].negative());
    }
  }
  std::vector<Vec3d> multiply(std::span<const Vec3d> x) const {
    std::vector<Vec3d> product(x.begin(), x.end());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [p, q] = pairs[i];
      const Vec3d change = blocks[i] * (x[p] - x[q]);
      product[p] = product[p] + change;
      product[q] = product[q] - change;
    }
    return product;
  }
};

Pairs grid(std::uint32_t side) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      const std::uint32_t v = i * side + j;
      if (i + 1 < side) pairs.push_back({v, v + side});
      if (j + 1 < side) pairs.push_back({v, v + 1});
      if (i + 1 < side && j + 1 < side) pairs.push_back({v, v + side + 1});
    }
  }
  return pairs;
}

Pairs star(std::uint32_t count) {
  Pairs pairs;
  for (std::uint32_t v = 1; v < count; ++v) pairs.push_back({0, v});
  return pairs;
}

Pairs all_with_all(std::uint32_t count) {
  Pairs pairs;
  for (std::uint32_t p = 0; p < count; ++p) {
    for (std::uint32_t q = p + 1; q < count; ++q) pairs.push_back({p, q});
  }
  return pairs;
}

TEST(SparseFactor, SolvesWhatItFactored) {
  const Matrix matrices[] = {{0, {}, 51},        {1, {}, 52},
                             {7, {}, 53},        {2, {{0, 1}}, 54},
                             {40, star(40), 55}, {23, all_with_all(23), 56},
                             {60, star(20), 57}, {15 * 15, grid(15), 58}};
  for (const Matrix& matrix : matrices) {
    SparseFactor factor(matrix.count, matrix.pairs);
    const std::vector<Vec3d> x = random_vectors(matrix.count, 1, 59);
    for (int again = 0; again < 2; ++again) {
      matrix.fill(factor);
      factor.factorise();
      std::vector<Vec3d> solution(matrix.count);
      factor.solve(matrix.multiply(x), solution);
      EXPECT_LT(largest_difference(solution, x), 1e-11) << matrix.count;
    }
  }
}

TEST(SymmetricBlock, InverseUndoesIt) {
  const std::vector<Vec3d> n = random_vectors(60, 1, 81);
  for (std::size_t i = 0; i + 2 < n.size(); i += 3) {
    SymmetricBlock block = SymmetricBlock::outer(n[i], 1e3);
    block += SymmetricBlock::outer(n[i + 1], 10);
    block.add_diagonal(0.5);
    const Vec3d x = n[i + 2];
    EXPECT_LT(norm(block.inverse(0.5) * (block * x) - x), 1e-11);
    EXPECT_LT(norm(block * (block.inverse(0.5) * x) - x), 1e-11);
  }
}

}  // namespace supple::backward_euler_test
