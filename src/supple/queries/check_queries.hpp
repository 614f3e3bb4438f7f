#pragma once

#include <cstddef>

#include "supple/queries.hpp"
#include "world/world.hpp"

namespace supple {

// These throw an error that names `call`.

/// When a largest distance is negative or NaN.
void check_distance(double distance, const char* call);
/// When the numbers of queries and results differ.
void check_counts(std::size_t queries, std::size_t results, const char* call);
/// When the surface of an object that the query sees is open. The first call takes O(n log n).
void check_closed(const World& world, const QueryFilter& seen, const char* call);

/// Whether a query sees an object.
inline bool sees(const QueryFilter& filter, ObjectId id, const ObjectOptions& options) {
  return (!filter.object || *filter.object == id) && (options.group & filter.mask) != 0;
}

}  // namespace supple
