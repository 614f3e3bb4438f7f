#include "mpi_ranks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "options/option_needs.hpp"
#include "options/options.hpp"
#include "supple/error.hpp"
#include "supple/threads.hpp"

namespace supple::cli {

MpiRanks::MpiRanks() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

void MpiRanks::together(const std::function<void()>& work) {
  std::exception_ptr thrown;
  std::string error;
  try {
    work();
  } catch (const std::bad_alloc&) {
    thrown = std::current_exception();
    error = "the memory is used up; start more ranks, or ranks on more machines";
  } catch (const std::exception& e) {
    thrown = std::current_exception();
    error = e.what();
  }
  const int lowest = first_with(thrown != nullptr);
  if (lowest == size_) return;
  if (lowest == 0) {
    has_ended_ = true;
    if (rank_ == 0) std::rethrow_exception(thrown);
    throw EndedByAll{};
  }
  end(*first(thrown ? std::optional(fmt::format("rank {}: {}", rank_, error)) : std::nullopt));
}

int MpiRanks::largest(int number) {
  MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return number;
}

void MpiRanks::check(const DetectionOptions& options, const Input& input) {
  const SceneOptions& scene = input.simulation.scene;
  const struct {
    bool is_given;
    const char* what;
  } refused[] = {
      {options.limits.max_contacts != RunLimits{}.max_contacts, "--max-contacts"},
      {options.json_content.node_pairs.has_value(), "--node-pairs"},
      {scene.bounding_volume != BoundingVolume::aabb, "a bounding volume other than aabb"},
      {scene.comparison.colliding_vertices, "colliding vertices"},
      {scene.comparison.lazy_refit, "lazy refit"},
      {scene.manifolds, "manifolds"},
      {has_continuous(scene) && scene.continuous_listing == ContinuousListing::first,
       "continuous listing first"},
      {std::ranges::any_of(input.objects, [](const InputObject& object) { return object.options.weld; }),
       "weld"},
  };
  for (const auto& [is_given, what] : refused) {
    if (is_given) fail("{}: several ranks do not have it; leave it out, or start one process", what);
  }
}

/// The lowest rank for which it is true; the number of ranks when there is none.
int MpiRanks::first_with(bool has_text) {
  int lowest = has_text ? rank_ : size_;
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return lowest;
}

std::optional<std::string> MpiRanks::first(const std::optional<std::string>& text) {
  const int lowest = first_with(text.has_value());
  if (lowest == size_) return std::nullopt;
  std::string found = lowest == rank_ ? *text : std::string();
  auto length = static_cast<int>(found.size());
  MPI_Bcast(&length, 1, MPI_INT, lowest, MPI_COMM_WORLD);
  found.resize(static_cast<std::size_t>(length));
  MPI_Bcast(found.data(), length, MPI_CHAR, lowest, MPI_COMM_WORLD);
  return found;
}

void MpiRanks::end(const std::string& error) {
  has_ended_ = true;
  if (rank_ != 0) throw EndedByAll{};
  throw Error(error);
}

std::uint32_t MpiRanks::default_threads() const {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
  int ranks = 1;
  MPI_Comm_size(machine, &ranks);
  MPI_Comm_free(&machine);
  return std::max(1u, usable_cores() / static_cast<std::uint32_t>(ranks));
}

}  // namespace supple::cli
