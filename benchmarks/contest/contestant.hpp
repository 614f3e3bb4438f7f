#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "supple/broad_phase.hpp"
#include "supple/proximity.hpp"
#include "workloads/cloth_steps.hpp"
#include "workloads/deforming_copies.hpp"
#include "workloads/moving_boxes.hpp"
#include "workloads/query_tasks.hpp"

namespace supple::benchmarks {

/// A digest of a set of pairs that does not depend on their order.
struct PairDigest {
  std::uint64_t count = 0;
  std::uint64_t hash = 0;

  /// Each 64-bit number names one side; the order of the sides does not matter.
  void add(std::uint64_t a, std::uint64_t b);
  bool operator==(const PairDigest&) const = default;
};

/// A part of the last frame.
struct StageTime {
  const char* name = "";
  double cpu_milliseconds = 0;
};

/// A library, or a baseline, on one workload.
template <class Workload>
class Contestant {
 public:
  virtual ~Contestant() = default;
  /// Builds data structures from the initial state. Not timed.
  virtual void prepare(const Workload& workload) = 0;
  /// Timed: takes the new state of the workload and writes each pair once into an array.
  virtual void frame(const Workload& workload) = 0;
  /// The pairs of the last frame. Not timed.
  virtual PairDigest pairs() const = 0;
  virtual std::vector<StageTime> stages() const { return {}; }
};

using BoxContestant = Contestant<MovingBoxes>;
using CopiesContestant = Contestant<DeformingCopies>;

/// Two elements of one mesh by vertices: a vertex and a face {v, v, v}, {f0, f1, f2}, or two edges. Pairs
/// that share a vertex are not candidates.
struct ElementPair {
  bool is_edge_edge = false;
  std::uint32_t a = 0, b = 0;  ///< vertex and triangle, or indices of two edges as `MeshEdges` numbers them
};

/// The distinct edges of a mesh, smaller vertex first, in ascending order.
std::vector<std::array<std::uint32_t, 2>> edges_of(const std::vector<Triangle>& triangles);

/// Finds candidates only: all `ElementPair`s whose boxes around both ends of the step overlap.
class ClothContestant : public Contestant<ClothStep> {
 public:
  PairDigest pairs() const override;
  /// The candidates of the last frame, when the contestant lists them.
  virtual std::span<const ElementPair> candidates() const = 0;
};

/// Answers the queries of a task. `pairs` counts the answers.
class QueryContestant : public Contestant<QueryTask> {
 public:
  virtual bool answers_kind(QueryTaskKind kind) const = 0;
  /// One number for each query of the last frame: the distance of a point, 1 or 0 for inside and outside, or
  /// the first parameter of a ray, infinite without a triangle. Of penetrations: the number of vertices
  /// inside and the sum of their depths, for each of the two copies. Of distances: the distance.
  std::span<const double> answers() const { return answers_; }
  PairDigest pairs() const override { return {answers_.size(), 0}; }

 protected:
  std::vector<double> answers_;
};

/// How to make a contestant, and the largest size for which it is fast enough to run.
template <class Contestant>
struct Entry {
  std::string name;
  std::function<std::unique_ptr<Contestant>()> make;
  std::size_t largest = std::numeric_limits<std::size_t>::max();  ///< boxes or triangles
};

/// All contestants except Supple whose libraries were found at build time.
std::vector<Entry<BoxContestant>> other_box_contestants();
std::vector<Entry<CopiesContestant>> other_copies_contestants();
std::vector<Entry<ClothContestant>> other_cloth_contestants();
/// Vertices and faces, and edges, at the start of the step, whose distance is at most twice the margin.
std::vector<Entry<Contestant<ClothStep>>> other_near_cloth_contestants(double margin);
std::vector<Entry<QueryContestant>> other_query_contestants();
/// Libraries that were not found.
std::vector<std::string> missing_libraries();

std::unique_ptr<BoxContestant> make_supple_boxes(std::uint32_t threads,
                                                 BroadPhaseMethod method = BroadPhaseMethod::automatic);
/// One thread; `moving` is the dirty list of every frame.
std::unique_ptr<BoxContestant> make_supple_boxes_with_dirty_list(std::vector<std::uint32_t> moving);
/// What a contestant on deforming copies finds: pairs of triangles, or also contact points and normals, which
/// is Supple's default.
enum class CopyResults : std::uint8_t { pairs, contact_points };
std::unique_ptr<CopiesContestant> make_supple_copies(std::uint32_t threads,
                                                     CopyResults results = CopyResults::contact_points);
/// `pairs` are the contacts; the stages include the number of candidates.
std::unique_ptr<Contestant<ClothStep>> make_supple_cloth(std::uint32_t threads);

/// The candidates of a cloth by `BroadPhase` alone: all boxes in one call, and pairs of vertices with faces
/// and of edges with edges.
std::unique_ptr<ClothContestant> make_supple_cloth_boxes(std::uint32_t threads);
/// Proximity of a cloth with itself at the start of the step; `pairs` are those of the listing.
std::unique_ptr<Contestant<ClothStep>> make_supple_near_cloth(std::uint32_t threads, double margin,
                                                              ProximityListing listing);

std::unique_ptr<QueryContestant> make_supple_queries(std::uint32_t threads);

/// Limits Supple and Embree to an instruction set of x86-64: "avx512", "avx2" or "sse4". The others use what
/// they were compiled for. Throws `Error` for another name or one that this machine does not have.
void limit_instruction_set(const std::string& name);
/// The name that Embree has for the limit; empty without one.
const std::string& embree_instruction_set();

/// Processor time of the calling process.
double cpu_milliseconds();
double wall_milliseconds();

}  // namespace supple::benchmarks
