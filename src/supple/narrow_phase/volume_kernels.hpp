#pragma once

#include <cstdint>
#include <span>

#include "narrow_phase/overlap_kernels.hpp"
#include "octree/volumes/node_volumes.hpp"

namespace supple {

/// Clears the bits of pairs of children whose oriented boxes or k-DOPs are apart. `masks` are those of
/// `overlap_masks` of their boxes. Oriented boxes are compared along 15 axes (Gottschalk, Lin and Manocha,
/// 1996), k-DOPs along their directions. Never misses an overlap. Both views are of the same kind.
void separate_volumes(std::span<const NodePair> pairs, const NodeVolumesView& a, const NodeVolumesView& b,
                      const RelativePlacement& placement, std::uint64_t* masks);

}  // namespace supple
