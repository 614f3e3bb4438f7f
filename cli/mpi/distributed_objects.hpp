#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "moving/moving_objects.hpp"
#include "mpi/mpi_ranks.hpp"
#include "supple/distributed.hpp"

namespace supple::cli {

/// The objects of an input on several ranks. Each rank moves a run of consecutive objects, with about as many
/// triangles as the others; a distributed scene finds the contacts, which are on rank 0. Where bodies respond
/// to contacts, each rank moves all objects: the impulses on a body depend on those on all others, in the
/// order of the contacts.
class DistributedObjects : public MovingObjects {
 public:
  DistributedObjects(MpiRanks& ranks, Input& input, bool records);

  const DetectResult& detect(const DetectRequest& request) override;
  const DetectResult& step(const DetectRequest& request) override;
  VerifyReport verify(const CallLimits& limits) override { return scene_.verify(limits); }
  std::vector<ObjectId> turned() override;
  std::vector<BodyEnergy> energies() override;
  std::optional<std::string> warning_of_long_steps() override;
  std::span<const Vec3d> positions(ObjectId object) const override;
  int rank_of(ObjectId object) const override;
  void release_meshes(Input& input) override;
  int rank_count() const override { return ranks_.size(); }

 private:
  void add_objects(Input& input);
  void place_objects();
  void undo_step();
  const DetectResult& find_contacts();
  void fetch_positions();
  std::uint32_t first_of(int rank) const { return firsts_[static_cast<std::size_t>(rank)]; }
  bool is_mine(std::uint32_t object) const {
    return object >= first_of(ranks_.rank()) && object < first_of(ranks_.rank() + 1);
  }
  bool moves(std::uint32_t object) const { return moves_all_ || is_mine(object); }
  // The numbers of an object in the simulation of this rank and among all.
  ObjectId local(std::uint32_t object) const { return {object - number_of({0})}; }
  std::uint32_t number_of(ObjectId of_simulation) const {
    return of_simulation.index + (moves_all_ ? 0 : first_of(ranks_.rank()));
  }

  MpiRanks& ranks_;
  const Input& input_;
  bool is_continuous_, records_, moves_all_;
  std::vector<std::uint32_t> firsts_;  ///< the first object of each rank, and the number of objects
  DistributedScene scene_;
  DetectResult result_;
  std::stop_source no_detection_;            ///< of the simulation
  std::vector<std::vector<Vec3d>> before_;   ///< of this rank's objects that move on paths
  std::vector<std::vector<Vec3d>> fetched_;  ///< on rank 0, by object of another rank
};

}  // namespace supple::cli
