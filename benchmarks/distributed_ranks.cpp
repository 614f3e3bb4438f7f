// Times steps of a distributed scene, or of one scene with threads. Built with -DSUPPLE_BUILD_BENCHMARKS=ON.
//
//   mpirun -n RANKS supple_distributed_ranks WORKLOAD STEPS      one thread a rank
//   mpirun -n 1 --bind-to none supple_distributed_ranks WORKLOAD STEPS --scene THREADS      one `Scene`
//
// WORKLOAD is balls:N:FREQUENCY, N deforming balls of 20 FREQUENCY^2 triangles in a cube, dealt to the ranks
// in turn; or sheet:SIDE, a waving sheet of 2 SIDE^2 triangles that is tested against itself and 16 balls,
// cut into one strip a rank. Prints a line of JSON.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "supple/distributed.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple {
namespace {

/// An object, or the part of it that this rank has.
struct Owned {
  ObjectId id;
  std::vector<Vec3d> rest, now;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> vertex_ids, triangle_ids;  // of a part
  Vec3d place;
  bool is_sheet = false;
  std::uint32_t number = 0;
};

Owned ball(std::uint32_t i, const TriangleMesh& mesh, Vec3d place) {
  Owned object;
  object.id = {i};
  object.rest = object.now = mesh.positions;
  object.triangles = mesh.triangles;
  object.place = place;
  object.number = i;
  return object;
}

/// The rows [begin, end) of a sheet of side x side squares.
Owned strip(std::uint32_t side, std::uint32_t begin, std::uint32_t end) {
  Owned part;
  part.is_sheet = true;
  for (std::uint32_t row = begin; row <= end; ++row) {
    for (std::uint32_t column = 0; column <= side; ++column) {
      part.vertex_ids.push_back(row * (side + 1) + column);
      part.rest.push_back({double(column) / side, 0, double(row) / side});
    }
  }
  for (std::uint32_t row = begin; row < end; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const std::uint32_t v = (row - begin) * (side + 1) + column, w = v + side + 1;
      part.triangles.push_back({v, w, v + 1});
      part.triangles.push_back({v + 1, w, w + 1});
      part.triangle_ids.push_back(2 * (row * side + column));
      part.triangle_ids.push_back(2 * (row * side + column) + 1);
    }
  }
  part.now = part.rest;
  return part;
}

std::vector<Owned> objects_of(const std::string& workload, int rank, int ranks) {
  std::vector<Owned> owned;
  std::uint32_t count = 16, frequency = 30, side = 0;
  if (std::sscanf(workload.c_str(), "balls:%u:%u", &count, &frequency) != 2 &&
      std::sscanf(workload.c_str(), "sheet:%u", &side) != 1) {
    std::fprintf(stderr, "distributed_ranks: the workload is balls:N:FREQUENCY or sheet:SIDE\n");
    std::exit(2);
  }
  TriangleMesh mesh = make_icosphere(frequency);
  if (side != 0) {
    for (Vec3d& p : mesh.positions) p = p * 0.1;
    owned.push_back(strip(side, side * static_cast<std::uint32_t>(rank) / static_cast<std::uint32_t>(ranks),
                          side * static_cast<std::uint32_t>(rank + 1) / static_cast<std::uint32_t>(ranks)));
  }
  const auto edge = static_cast<std::uint32_t>(std::ceil(std::cbrt(count)));
  for (std::uint32_t i = 0; i < count; ++i) {
    if (static_cast<int>(i) % ranks != rank) continue;
    const Vec3d place =
        side != 0 ? Vec3d{0.2 + 0.2 * (i % 4), 0, 0.2 + 0.2 * (i / 4)}
                  : 0.85 * Vec3d{double(i % edge), double(i / edge % edge), double(i / edge / edge)};
    owned.push_back(ball(1 + i, mesh, place));
  }
  return owned;
}

void move(Owned& object, int step) {
  for (std::size_t v = 0; v < object.rest.size(); ++v) {
    const Vec3d p = object.rest[v];
    const double t = 0.1 * step;
    object.now[v] = object.is_sheet
                        ? Vec3d{p.x, 0.02 * std::sin(40 * p.x + t) * std::cos(30 * p.z), p.z}
                        : object.place + Vec3d{p.x * (1 + 0.05 * std::sin(t + object.number)), p.y,
                                               p.z * (1 + 0.05 * std::cos(t + object.number))};
  }
}

double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::atof(line.c_str() + 6) / 1024;
  }
  return 0;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int run(int argc, char** argv) {
  if (argc != 3 && argc != 5) {
    std::fprintf(stderr, "usage: supple_distributed_ranks WORKLOAD STEPS [--scene THREADS]\n");
    return 2;
  }
  const int steps = std::atoi(argv[2]);
  const bool is_plain = argc == 5;
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  std::vector<Owned> owned = objects_of(argv[1], rank, ranks);
  std::unique_ptr<Scene> plain;
  std::unique_ptr<DistributedScene> distributed;
  if (is_plain) {
    plain = std::make_unique<Scene>(SceneOptions{.threads = static_cast<std::uint32_t>(std::atoi(argv[4]))});
  } else {
    distributed = std::make_unique<DistributedScene>(
        MPI_COMM_WORLD, DistributedOptions{.scene = {.threads = 1}, .results = ResultPlacement::spread});
  }
  double triangles = 0;
  for (Owned& object : owned) {
    move(object, 0);
    triangles += static_cast<double>(object.triangles.size());
    const ObjectOptions options{.self_collision = object.is_sheet};
    if (is_plain) {
      object.id = plain->add(object.now, object.triangles, options);
    } else if (object.is_sheet) {
      distributed->add_part(object.id, object.now, object.triangles, {object.vertex_ids, object.triangle_ids},
                            options);
    } else {
      distributed->add(object.id, object.now, object.triangles, options);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &triangles, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  std::vector<double> seconds, bytes, messages;
  double contacts = 0;
  for (int step = 0; step < steps + 2; ++step) {
    for (Owned& object : owned) move(object, step);
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin = now();
    for (const Owned& object : owned)
      is_plain ? plain->set_positions(object.id, object.now)
               : distributed->set_positions(object.id, object.now);
    const DetectResult& result = is_plain ? plain->detect() : distributed->detect();
    MPI_Barrier(MPI_COMM_WORLD);
    contacts = static_cast<double>(result.contacts.size());
    if (step < 2) continue;  // they send the topology and build octrees
    seconds.push_back(now() - begin);
    if (is_plain) continue;
    bytes.push_back(static_cast<double>(distributed->stats().bytes_sent));
    messages.push_back(static_cast<double>(distributed->stats().messages_sent));
  }
  const auto median = [](std::vector<double> values) {
    if (values.empty()) return 0.0;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
  };
  double most[] = {median(bytes), median(messages), peak_megabytes(),
                   is_plain ? 0 : double(distributed->stats().triangles)};
  double sums[] = {contacts, most[0], most[3]};
  MPI_Allreduce(MPI_IN_PLACE, most, 4, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  if (rank == 0) {
    std::printf(
        "{\"workload\": \"%s\", \"ranks\": %d, \"threads\": %d, \"triangles\": %.0f, \"contacts\": %.0f, "
        "\"step_seconds\": %.6f, \"bytes_of_rank\": %.0f, \"messages_of_rank\": %.0f, \"bytes\": %.0f, "
        "\"needed_triangles\": %.0f, \"imbalance\": %.3f, \"megabytes_of_rank\": %.1f}\n",
        argv[1], is_plain ? 0 : ranks, is_plain ? std::atoi(argv[4]) : 1, triangles, sums[0], median(seconds),
        most[0], most[1], sums[1], sums[2], is_plain ? 1.0 : distributed->stats().imbalance, most[2]);
  }
  return 0;
}

}  // namespace
}  // namespace supple

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int status = supple::run(argc, argv);
  MPI_Finalize();
  return status;
}
