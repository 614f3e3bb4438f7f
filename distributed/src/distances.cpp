// Distances of objects: one rank gets both objects of a pair, whole.

#include <algorithm>
#include <limits>

#include "distributed_implementation.hpp"
#include "queries/check_queries.hpp"
#include "queries/queries.hpp"

namespace supple {

std::vector<ProximityPair> DistributedScene::Implementation::distances(double max_distance) {
  ranks.together([&] { check_distance(max_distance, "distances"); });
  // Rounded up by more than the sums of boxes can lose.
  const double growth = 0.5 * max_distance * (1 + 0x1p-19) + std::numeric_limits<float>::min();
  question_ = {};
  prepare(true, std::min(growth, double{std::numeric_limits<float>::max()}));
  ranks.together([&] {
    clear_lists();
    for (const ProximityPair& pair : Queries(world()).distances(max_distance, {})) {
      const ProximityPair found = named(pair);
      lists_of(found.object_a).proximity_pairs.push_back(found);
    }
  });
  send_lists();
  end_step();
  return lists_.proximity_pairs;
}

}  // namespace supple
