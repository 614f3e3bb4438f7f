#pragma once

#include <memory>

#include "core/kept_lists.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// The manifolds of a scene from step to step; see `Manifold`. They are in the library supple::manifold.
class ManifoldMaker {
 public:
  virtual ~ManifoldMaker() = default;
  /// Finds the manifolds of a result over this world, which has the curves and the pairs; none for an empty
  /// one. `lists_all_pairs`: none is left out of the pairs of two objects. The lists are those of the last
  /// step until `publish`.
  virtual void find(const DetectResult& result, const World& world, bool lists_all_pairs) = 0;
  /// Adds the lists to the result. Does not fail.
  virtual void publish(DetectResult& result) = 0;
  /// Keeps each list that `publish` adds.
  virtual void keep(KeptLists& kept) = 0;
};

using MakeManifoldMaker = std::unique_ptr<ManifoldMaker> (*)();
/// Any number of threads may set the same function.
void set_manifold_maker(MakeManifoldMaker make);
/// Throws `Error` when none was set.
std::unique_ptr<ManifoldMaker> make_manifold_maker();

}  // namespace supple
