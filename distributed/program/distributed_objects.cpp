#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "commands/build_simulation.hpp"
#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "mpi_ranks.hpp"
#include "session/messages/long_steps.hpp"
#include "supple/distributed.hpp"
#include "supple/error.hpp"
#include "supple/result_lists.hpp"

namespace supple::cli {
namespace {

constexpr int tag_of_positions = 4301;

/// The first object of each rank, and the number of objects.
std::vector<std::uint32_t> firsts_of(const Input& input, int ranks) {
  std::uint64_t all = 0, before = 0;
  for (const InputObject& object : input.objects) all += object.mesh.triangles.size() + 1;
  std::vector<std::uint32_t> firsts{0};
  for (std::uint32_t i = 0; i < input.objects.size(); ++i) {
    // An object belongs to the rank in whose part of all triangles its middle is.
    const std::uint64_t count = input.objects[i].mesh.triangles.size() + 1;
    const auto rank =
        static_cast<std::size_t>(static_cast<std::uint64_t>(ranks) * (2 * before + count) / (2 * all));
    firsts.resize(std::max(firsts.size(), rank + 1), i);
    before += count;
  }
  firsts.resize(static_cast<std::size_t>(ranks) + 1, static_cast<std::uint32_t>(input.objects.size()));
  return firsts;
}

/// Random numbers of the simulation depend on the number of the object among all.
std::optional<Motion> numbered(std::optional<Motion> motion, std::uint64_t number) {
  if (!motion) return motion;
  if (auto* const springs = std::get_if<MassSpringMotion>(&*motion); springs && !springs->seed)
    springs->seed = number;
  if (auto* const rigid = std::get_if<RigidMotion>(&*motion); rigid && !rigid->seed) rigid->seed = number;
  return motion;
}

bool has_response(const Input& input) {
  return input.simulation.response && std::ranges::any_of(input.objects, [](const InputObject& object) {
           return motion_of<MassSpringMotion>(object) != nullptr;
         });
}

SimulationOptions options_of_rank(const Input& input, const MpiRanks& ranks) {
  SimulationOptions options = input.simulation;
  if (!has_response(input)) options.response.reset();
  if (options.scene.threads == 0) options.scene.threads = ranks.default_threads();
  return options;
}

/// The objects of an input on several ranks. Each rank moves a run of consecutive objects, with about as many
/// triangles as the others; a distributed scene finds the contacts, which are on rank 0. Where bodies respond
/// to contacts, each rank moves all objects: the impulses on a body depend on those on all others, in the
/// order of the contacts.
class DistributedObjects : public MovingObjects {
 public:
  DistributedObjects(MpiRanks& ranks, Input& input, bool records)
      : MovingObjects(options_of_rank(input, ranks)),
        ranks_(ranks),
        input_(input),
        is_continuous_(contains(input.simulation.scene.contacts, ContactKinds::continuous)),
        records_(records),
        moves_all_(has_response(input)),
        firsts_(firsts_of(input, ranks.size())),
        scene_(MPI_COMM_WORLD, {.scene = simulation_.options().scene}) {
    no_detection_.request_stop();
    ranks.together([&] { add_objects(input); });
  }

  const DetectResult& detect(const DetectRequest&) override { return find_contacts(); }

  const DetectResult& step(const DetectRequest&) override {
    std::optional<std::string> fault;
    ranks_.together([&] {
      if (const auto error = simulation_.try_step({.stop = no_detection_.get_token()})) fault = error->what();
      if (!fault) place_objects();
    });
    const auto first = ranks_.first(fault);
    if (first && !fault) undo_step();
    if (first) throw MotionError(*first, {}, simulation_.step_count() + 1);
    return find_contacts();
  }

  VerifyReport verify(const CallLimits& limits) override { return scene_.verify(limits); }

  /// Each rank knows it of its own objects, which follow those of lower ranks.
  std::vector<ObjectId> turned() override {
    std::vector<std::uint8_t> has_turned(input_.objects.size(), 0);
    for (const ObjectId object : MovingObjects::turned()) has_turned[number_of(object)] = 1;
    MPI_Allreduce(MPI_IN_PLACE, has_turned.data(), static_cast<int>(has_turned.size()), MPI_UINT8_T, MPI_MAX,
                  MPI_COMM_WORLD);
    std::vector<ObjectId> turned;
    for (std::uint32_t i = 0; i < has_turned.size(); ++i) {
      if (has_turned[i] != 0) turned.push_back({i});
    }
    return turned;
  }

  std::vector<BodyEnergy> energies() override {
    std::vector<MassSpringEnergy> all(input_.objects.size());
    std::vector<std::byte> bytes(all.size() * sizeof all[0]);
    for (const auto& [object, energy] : MovingObjects::energies())
      std::memcpy(bytes.data() + number_of(object) * sizeof energy, &energy, sizeof energy);
    MPI_Allreduce(MPI_IN_PLACE, bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, MPI_BOR,
                  MPI_COMM_WORLD);
    std::memcpy(all.data(), bytes.data(), bytes.size());
    std::vector<BodyEnergy> energies;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      if (motion_of<MassSpringMotion>(input_.objects[i])) energies.push_back({{i}, all[i]});
    }
    return energies;
  }

  std::optional<std::string> warning_of_long_steps() override {
    viewer::LongSteps steps = viewer::find_long_steps(simulation_);
    steps.worst.index = number_of(steps.worst);
    if (moves_all_ && ranks_.rank() != 0) steps.count = 0;  // rank 0 has counted them
    std::vector<viewer::LongSteps> of_ranks(static_cast<std::size_t>(ranks_.size()));
    MPI_Gather(&steps, sizeof steps, MPI_BYTE, of_ranks.data(), sizeof steps, MPI_BYTE, 0, MPI_COMM_WORLD);
    if (ranks_.rank() != 0) return std::nullopt;
    for (std::size_t rank = 1; rank < of_ranks.size(); ++rank) {
      const std::uint64_t count = steps.count + of_ranks[rank].count;
      if (of_ranks[rank].count > 0 && of_ranks[rank].stable_step < steps.stable_step) steps = of_ranks[rank];
      steps.count = count;
    }
    return viewer::warning_of_long_steps(steps, simulation_.options().time_step,
                                         steps.count > 0 ? input_.name(steps.worst) : std::string());
  }

  std::span<const Vec3d> positions(ObjectId object) const override {
    if (moves(object.index)) return simulation_.positions(local(object.index));
    const InputObject& found = input_.objects[object.index];
    return found.motion ? fetched_[object.index] : found.mesh.positions;
  }

  int rank_of(ObjectId object) const override {
    if (moves_all_) return 0;
    return static_cast<int>(std::ranges::upper_bound(firsts_, object.index) - firsts_.begin()) - 1;
  }

  /// Rank 0 reports on contacts of objects with themselves, and on what a single object lacks.
  void release_meshes(Input& input) override {
    if (input.objects.size() == 1 && ranks_.rank() == 0) return;
    for (InputObject& object : input.objects) {
      if (ranks_.rank() == 0 && object.options.self_collision) continue;
      object.mesh = {std::move(object.mesh.name), {}, {}};
    }
  }

  int rank_count() const override { return ranks_.size(); }

 private:
  void add_objects(Input& input) {
    if (ranks_.rank() != 0) {
      for (std::uint32_t i = 0; i < input.objects.size(); ++i) {
        if (!moves(i)) input.objects[i].mesh = {};
      }
    }
    std::vector<InputObject> own;
    for (std::uint32_t i = 0; i < input.objects.size(); ++i) {
      if (!moves(i)) continue;
      InputObject& object = input.objects[i];
      ObjectOptions options = object.options;
      options.name = input.name(ObjectId{i});
      if (input.simulation.response)
        options.margin = std::max(options.margin, least_margin(*input.simulation.response));
      options.edges.insert(options.edges.end(), object.mesh.edges.begin(), object.mesh.edges.end());
      options.points.insert(options.points.end(), object.mesh.points.begin(), object.mesh.points.end());
      object.motion = numbered(std::move(object.motion), i);
      const ObjectId id = moves_all_ ? add_object(simulation_, object) : add_positions(simulation_, object);
      if (is_mine(i)) scene_.add(ObjectId{i}, simulation_.positions(id), object.mesh.triangles, options);
      own.push_back({{}, object.options, object.motion});
      if (ranks_.rank() != 0 && !(records_ && rank_of({i}) == ranks_.rank())) object.mesh = {};
    }
    find_spins(own);
    fetched_.resize(ranks_.rank() == 0 ? input.objects.size() : 0);
  }

  void place_objects() {
    for (std::uint32_t i = first_of(ranks_.rank()); i < first_of(ranks_.rank() + 1); ++i) {
      if (!input_.objects[i].motion) continue;
      const std::span<const Vec3d> positions = simulation_.positions(local(i));
      if (is_continuous_)
        scene_.set_motion(ObjectId{i}, before_[local(i).index], positions);
      else
        scene_.set_positions(ObjectId{i}, positions);
    }
  }

  /// Bodies of other ranks have failed, so those of this rank go back to the step before, too.
  void undo_step() {
    for (const ObjectId object : simulation_.scene().objects()) {
      if (MassSpringBody* const body = simulation_.body(object)) body->undo_step();
    }
  }

  const DetectResult& find_contacts() {
    try {
      result_ = scene_.detect();
    } catch (const Error& error) {  // all ranks have it
      ranks_.end(error.what());
    }
    fetch_positions();
    return result_;
  }

  /// Rank 0 gets the positions of objects of other ranks that move and touch themselves.
  void fetch_positions() {
    if (moves_all_) return;
    std::vector<std::uint8_t> is_wanted(input_.objects.size(), 0);
    for_each_list([&]<class Row>(const ResultList<Row>&, auto member) {
      if constexpr (requires(const Row& row) { row.object_b; }) {
        for (const Row& row : member(result_)) {
          const std::uint32_t object = row.object_a.index;
          if (row.object_a == row.object_b && input_.objects[object].motion) is_wanted[object] = 1;
        }
      }
    });
    MPI_Bcast(is_wanted.data(), static_cast<int>(is_wanted.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
    for (int owner = 1; owner < ranks_.size(); ++owner) {
      for (std::uint32_t i = first_of(owner); i < first_of(owner + 1); ++i) {
        if (is_wanted[i] == 0) continue;
        if (is_mine(i)) {
          const std::span<const Vec3d> positions = simulation_.positions(local(i));
          MPI_Send(positions.data(), static_cast<int>(3 * positions.size()), MPI_DOUBLE, 0, tag_of_positions,
                   MPI_COMM_WORLD);
        } else if (ranks_.rank() == 0) {
          fetched_[i].resize(input_.objects[i].mesh.positions.size());
          MPI_Recv(fetched_[i].data(), static_cast<int>(3 * fetched_[i].size()), MPI_DOUBLE, owner,
                   tag_of_positions, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        }
      }
    }
  }

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
  std::vector<std::vector<Vec3d>> fetched_;  ///< on rank 0, by object of another rank
};

}  // namespace

std::unique_ptr<MovingObjects> MpiRanks::move(Input& input, bool records) {
  return std::make_unique<DistributedObjects>(*this, input, records);
}

}  // namespace supple::cli
