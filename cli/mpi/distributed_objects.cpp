#include "mpi/distributed_objects.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "commands/build_simulation.hpp"
#include "inputs/half_turns.hpp"
#include "inputs/inputs.hpp"
#include "session/messages/long_steps.hpp"
#include "supple/error.hpp"

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

}  // namespace

DistributedObjects::DistributedObjects(MpiRanks& ranks, Input& input, bool records)
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

void DistributedObjects::add_objects(Input& input) {
  if (ranks_.rank() != 0) {
    for (std::uint32_t i = 0; i < input.objects.size(); ++i) {
      if (!moves(i)) input.objects[i].mesh = {};
    }
  }
  Input own;
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
    own.objects.push_back({{}, object.options, object.motion});
    if (ranks_.rank() != 0 && !(records_ && rank_of({i}) == ranks_.rank())) object.mesh = {};
  }
  before_.resize(own.objects.size());
  turns_ = std::make_unique<HalfTurns>(simulation_, own);
  fetched_.resize(ranks_.rank() == 0 ? input.objects.size() : 0);
}

const DetectResult& DistributedObjects::detect(const DetectRequest&) {
  return find_contacts();
}

const DetectResult& DistributedObjects::step(const DetectRequest&) {
  std::optional<std::string> fault;
  ranks_.together([&] {
    for (std::size_t i = 0; i < before_.size() && is_continuous_; ++i) {
      const auto positions = simulation_.positions(ObjectId{static_cast<std::uint32_t>(i)});
      before_[i].assign(positions.begin(), positions.end());
    }
    if (const auto error = simulation_.try_step({.stop = no_detection_.get_token()})) fault = error->what();
    if (!fault) place_objects();
  });
  const auto first = ranks_.first(fault);
  if (first && !fault) undo_step();
  if (first) throw MotionError(*first, {}, simulation_.step_count() + 1);
  return find_contacts();
}

/// Bodies of other ranks have failed, so those of this rank go back to the step before, too.
void DistributedObjects::undo_step() {
  for (const ObjectId object : simulation_.scene().objects()) {
    if (MassSpringBody* const body = simulation_.body(object)) body->undo_step();
  }
}

void DistributedObjects::place_objects() {
  for (std::uint32_t i = first_of(ranks_.rank()); i < first_of(ranks_.rank() + 1); ++i) {
    if (!input_.objects[i].motion) continue;
    const std::span<const Vec3d> positions = simulation_.positions(local(i));
    if (is_continuous_)
      scene_.set_motion(ObjectId{i}, before_[local(i).index], positions);
    else
      scene_.set_positions(ObjectId{i}, positions);
  }
}

const DetectResult& DistributedObjects::find_contacts() {
  try {
    result_ = scene_.detect();
  } catch (const Error& error) {  // all ranks have it
    ranks_.end(error.what());
  }
  fetch_positions();
  return result_;
}

/// Rank 0 gets the positions of objects of other ranks that move and touch themselves.
void DistributedObjects::fetch_positions() {
  if (moves_all_) return;
  std::vector<std::uint8_t> is_wanted(input_.objects.size(), 0);
  const auto want = [&](std::span<const ContactGroup> groups) {
    for (const ContactGroup& group : groups) {
      if (group.a == group.b && input_.objects[group.a.index].motion) is_wanted[group.a.index] = 1;
    }
  };
  want(result_.groups);
  want(result_.continuous_groups);
  want(result_.proximity_groups);
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

int DistributedObjects::rank_of(ObjectId object) const {
  if (moves_all_) return 0;
  return static_cast<int>(std::ranges::upper_bound(firsts_, object.index) - firsts_.begin()) - 1;
}

/// Rank 0 reports on contacts of objects with themselves, and on what a single object lacks.
void DistributedObjects::release_meshes(Input& input) {
  if (input.objects.size() == 1 && ranks_.rank() == 0) return;
  for (InputObject& object : input.objects) {
    if (ranks_.rank() == 0 && object.options.self_collision) continue;
    object.mesh = {std::move(object.mesh.name), {}, {}};
  }
}

std::span<const Vec3d> DistributedObjects::positions(ObjectId object) const {
  if (moves(object.index)) return simulation_.positions(local(object.index));
  const InputObject& found = input_.objects[object.index];
  return found.motion ? fetched_[object.index] : found.mesh.positions;
}

/// Each rank knows it of its own objects, which follow those of lower ranks.
std::vector<ObjectId> DistributedObjects::turned() {
  std::vector<std::uint8_t> has_turned(input_.objects.size(), 0);
  for (const ObjectId object : turns_->find()) has_turned[number_of(object)] = 1;
  MPI_Allreduce(MPI_IN_PLACE, has_turned.data(), static_cast<int>(has_turned.size()), MPI_UINT8_T, MPI_MAX,
                MPI_COMM_WORLD);
  std::vector<ObjectId> turned;
  for (std::uint32_t i = 0; i < has_turned.size(); ++i) {
    if (has_turned[i] != 0) turned.push_back({i});
  }
  return turned;
}

std::vector<BodyEnergy> DistributedObjects::energies() {
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

std::optional<std::string> DistributedObjects::warning_of_long_steps() {
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

}  // namespace supple::cli
