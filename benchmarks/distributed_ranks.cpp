// Times steps of a distributed scene, or of one scene with threads. Built with -DSUPPLE_BUILD_BENCHMARKS=ON.
//
//   mpirun -n RANKS supple_distributed_ranks WORKLOAD STEPS      one thread a rank
//   mpirun -n 1 --bind-to none supple_distributed_ranks WORKLOAD STEPS --scene THREADS      one `Scene`
//
// WORKLOAD is balls:N:FREQUENCY, N deforming balls of 20 FREQUENCY^2 triangles in a cube, dealt to the ranks
// in turn; or sheet:SIDE, a waving sheet of 2 SIDE^2 triangles that is tested against itself and 16 balls,
// cut into one strip for each rank; or tiles:SIDE, such a sheet cut into one tile for each rank, with one
// small ball for about 31,000 of its triangles, which is on the rank of the tile at its center, for ranks
// that are a power of two. Prints a line of JSON. Values `…_of_rank` are those of the rank that has most,
// other counts are sums over all ranks. Processor time is that outside of MPI, memory that besides the
// meshes.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "mpi_calls.hpp"
#include "regions.hpp"
#include "supple/broad_phase.hpp"
#include "supple/distributed.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple {
namespace {

#ifdef __clang__
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "g++ " __VERSION__;
#endif

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

struct Range {
  std::uint32_t begin, end;
};

/// The part of 0 … count - 1 that is number i of n.
Range range_of(std::uint32_t count, int i, int n) {
  const auto bound = [&](int at) {
    return static_cast<std::uint32_t>(std::uint64_t{count} * static_cast<std::uint64_t>(at) /
                                      static_cast<std::uint64_t>(n));
  };
  return {bound(i), bound(i + 1)};
}

/// A part of a sheet of side x side squares.
Owned part_of_sheet(std::uint32_t side, Range rows, Range columns) {
  Owned part;
  part.is_sheet = true;
  for (std::uint32_t row = rows.begin; row <= rows.end; ++row) {
    for (std::uint32_t column = columns.begin; column <= columns.end; ++column) {
      part.vertex_ids.push_back(row * (side + 1) + column);
      part.rest.push_back({double(column) / side, 0, double(row) / side});
    }
  }
  const std::uint32_t stride = columns.end - columns.begin + 1;
  for (std::uint32_t row = rows.begin; row < rows.end; ++row) {
    for (std::uint32_t column = columns.begin; column < columns.end; ++column) {
      const std::uint32_t v = (row - rows.begin) * stride + column - columns.begin, w = v + stride;
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
      std::sscanf(workload.c_str(), "sheet:%u", &side) != 1 &&
      std::sscanf(workload.c_str(), "tiles:%u", &side) != 1) {
    std::fprintf(stderr, "distributed_ranks: the workload is balls:N:FREQUENCY, sheet:SIDE or tiles:SIDE\n");
    std::exit(2);
  }
  const bool are_tiles = workload[0] == 't';
  auto edge = static_cast<std::uint32_t>(std::ceil(std::cbrt(count)));
  int columns = 1, column = 0, rows = are_tiles ? 1 : ranks, row = are_tiles ? 0 : rank;
  for (int half = ranks / 2; are_tiles && half > 0; half /= 2) {  // numbered as by recursive bisection
    const bool is_x = columns <= rows;
    (is_x ? column : row) = 2 * (is_x ? column : row) + rank / half % 2;
    (is_x ? columns : rows) *= 2;
  }
  if (are_tiles) {
    edge = std::max(1u, side / 125);
    count = edge * edge;
    frequency = 8;
  } else if (side != 0) {
    edge = 4;
  }
  TriangleMesh mesh = make_icosphere(frequency);
  if (side != 0) {
    for (Vec3d& p : mesh.positions) p = p * (0.4 / edge);
    owned.push_back(part_of_sheet(side, range_of(side, row, rows), range_of(side, column, columns)));
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = (i % edge + 0.5) / edge, z = (i / edge + 0.5) / edge;  // on the sheet
    const bool is_here = are_tiles
                             ? static_cast<int>(x * columns) == column && static_cast<int>(z * rows) == row
                             : static_cast<int>(i) % ranks == rank;
    if (!is_here) continue;
    const Vec3d place =
        side != 0 ? Vec3d{x, 0, z}
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

/// How many positions any method must send to other ranks when each rank has a region of space, all with the
/// same number of triangles by recursive coordinate bisection, and gets all triangles whose boxes meet it:
/// `from_here` when they are where this rank has them, `surface` when each is already where it is needed
/// once.
struct PositionsToSend {
  double from_here = 0, surface = 0;
};

PositionsToSend positions_to_send(const std::vector<Owned>& owned, int rank) {
  const Communicator communicator(MPI_COMM_WORLD);
  Regions regions(communicator);
  std::vector<WeightedPoint> centers;
  for (const Owned& object : owned) {
    for (const auto& [a, b, c] : object.triangles)
      centers.push_back({(object.now[a] + object.now[b] + object.now[c]) * (1.0 / 3), 1});
  }
  regions.divide(centers);
  PositionsToSend found;
  for (const Owned& object : owned) {
    std::vector<std::pair<std::uint32_t, int>> needed;  // a vertex and a rank
    for (const Triangle& corners : object.triangles) {
      const Aabb box =
          enclosing_box(std::array{object.now[corners[0]], object.now[corners[1]], object.now[corners[2]]});
      for (const int other : regions.ranks_of(box)) {
        for (const std::uint32_t v : corners) needed.push_back({v, other});
      }
    }
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    found.surface += static_cast<double>(needed.size() - object.now.size());
    for (const auto& [v, other] : needed) found.from_here += other != rank ? 1 : 0;
  }
  return found;
}

/// VmRSS is the memory now, VmHWM its peak.
double megabytes(const char* name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name)) return std::atof(line.c_str() + 6) / 1024;
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
  const double of_meshes = megabytes("VmRSS:");
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
  std::vector<double> seconds, bytes, messages, cpu;
  double contacts = 0;
  MpiCalls calls;  // of the last step
  for (int step = 0; step < steps + 2; ++step) {
    for (Owned& object : owned) move(object, step);
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin = now(), cpu_begin = cpu_seconds();
    const MpiCalls before = mpi_calls;
    for (const Owned& object : owned)
      is_plain ? plain->set_positions(object.id, object.now)
               : distributed->set_positions(object.id, object.now);
    const DetectResult& result = is_plain ? plain->detect() : distributed->detect();
    cpu.push_back(cpu_seconds() - cpu_begin - (mpi_calls.cpu_seconds - before.cpu_seconds));
    calls = {mpi_calls.collectives - before.collectives, mpi_calls.sends - before.sends};
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
  const double peak = megabytes("VmHWM:") - of_meshes;
  cpu.erase(cpu.begin(), cpu.begin() + std::min<std::ptrdiff_t>(2, std::ssize(cpu)));
  const DistributedStats work = is_plain ? DistributedStats{} : distributed->stats();
  distributed.reset();
  const PositionsToSend least = is_plain ? PositionsToSend{} : positions_to_send(owned, rank);
  double most[] = {median(bytes), median(messages),       peak,
                   median(cpu),   double(work.triangles), double(calls.sends)};
  double sums[] = {contacts,
                   most[0],
                   most[1],
                   most[4],
                   most[3],
                   double(work.clusters),
                   double(work.cluster_pairs),
                   least.from_here,
                   least.surface};
  MPI_Allreduce(MPI_IN_PLACE, most, std::size(most), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, sums, std::size(sums), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  if (rank == 0) {
    std::printf(
        "{\"workload\": \"%s\", \"ranks\": %d, \"threads\": %d, \"triangles\": %.0f, \"contacts\": %.0f, "
        "\"step_seconds\": %.6f, \"bytes_of_rank\": %.0f, \"bytes\": %.0f, \"messages_of_rank\": %.0f, "
        "\"messages\": %.0f, \"needed_triangles\": %.0f, \"imbalance\": %.3f, \"megabytes_of_rank\": %.1f, "
        "\"cpu_seconds_of_rank\": %.6f, \"cpu_seconds\": %.6f, \"needed_triangles_of_rank\": %.0f, "
        "\"sends_of_rank\": %.0f, \"collectives\": %llu, \"clusters\": %.0f, \"cluster_pairs\": %.0f, "
        "\"least_positions\": %.0f, \"surface_positions\": %.0f, \"compiler\": \"%s\"}\n",
        argv[1], is_plain ? 0 : ranks, is_plain ? std::atoi(argv[4]) : 1, triangles, sums[0], median(seconds),
        most[0], sums[1], most[1], sums[2], sums[3], work.imbalance, most[2], most[3], sums[4], most[4],
        most[5], static_cast<unsigned long long>(calls.collectives), sums[5], sums[6], sums[7], sums[8],
        compiler);
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
