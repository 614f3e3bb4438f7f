// Soft balls on all ranks of MPI, and a floor in parts: mpirun -n 2 example_many_ranks
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "supple/distributed.hpp"
#include "supple/models.hpp"

using supple::ObjectId;
using supple::Vec3d;

namespace {

/// The strip of a mesh between two of `count` parallel planes across x: the triangles whose first corner is
/// there, their vertices, and their corners as numbers of the strip.
struct Strip {
  std::vector<std::uint32_t> vertices, triangles;
  std::vector<Vec3d> positions;
  std::vector<supple::Triangle> corners;
};

Strip strip_of(const supple::TriangleMesh& mesh, double begin, double end) {
  constexpr std::uint32_t absent = ~std::uint32_t{0};
  Strip strip;
  std::vector<std::uint32_t> number(mesh.positions.size(), absent);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const double x = mesh.positions[mesh.triangles[t][0]].x;
    if (x < begin || x >= end) continue;
    strip.triangles.push_back(t);
    for (const std::uint32_t v : mesh.triangles[t]) number[v] = 0;
  }
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == absent) continue;
    number[v] = static_cast<std::uint32_t>(strip.vertices.size());
    strip.vertices.push_back(v);
    strip.positions.push_back(mesh.positions[v]);
  }
  for (const std::uint32_t t : strip.triangles) {
    supple::Triangle corners = mesh.triangles[t];
    for (std::uint32_t& corner : corners) corner = number[corner];
    strip.corners.push_back(corners);
  }
  return strip;
}

void run() {
  supple::DistributedScene scene(MPI_COMM_WORLD);
  const auto ranks = static_cast<std::uint32_t>(scene.rank_count());
  const auto rank = static_cast<std::uint32_t>(scene.rank());

  // Object 0 is the floor. Each rank has a strip of it.
  const supple::TriangleMesh floor = supple::make_cloth(40, 40, 8, 8);
  const Strip strip =
      strip_of(floor, -4.0 + 8.0 * rank / ranks, rank + 1 == ranks ? 5 : -4.0 + 8.0 * (rank + 1) / ranks);
  scene.add_part(ObjectId{0}, strip.positions, strip.corners, {strip.vertices, strip.triangles},
                 {.name = "floor", .is_static = true});

  // Objects 1 to 16 are balls. Each rank has every ranks-th of them.
  const supple::TriangleMesh ball = supple::make_icosphere(8);
  std::vector<Vec3d> positions = ball.positions;
  const auto place = [&](std::uint32_t i, int frame) {
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const Vec3d p = ball.positions[v];
      positions[v] = Vec3d{1.6 * (i % 4) - 2.4, 0.9 - 0.125 * frame, 1.6 * std::floor(i / 4) - 2.4} +
                     Vec3d{p.x, p.y * (1 - 0.0625 * frame), p.z};
    }
  };
  for (std::uint32_t i = rank; i < 16; i += ranks) {
    place(i, 0);
    scene.add(ObjectId{1 + i}, positions, ball.triangles);
  }

  for (int frame = 0; frame < 5; ++frame) {
    for (std::uint32_t i = rank; i < 16; i += ranks) {
      place(i, frame);
      scene.set_positions(ObjectId{1 + i}, positions);  // your simulation goes here
    }
    const supple::DetectResult& result = scene.detect();  // all ranks call it; the contacts are on rank 0
    if (rank == 0)
      std::printf("frame %d: %zu contacts of %zu pairs\n", frame, result.contacts.size(),
                  result.groups.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  run();  // the scene is gone before MPI ends
  MPI_Finalize();
}
