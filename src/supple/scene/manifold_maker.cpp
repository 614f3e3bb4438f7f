#include "scene/manifold_maker.hpp"

#include <atomic>

#include "core/error.hpp"

namespace supple {
namespace {

std::atomic<MakeManifoldMaker> maker_in_use = nullptr;

}  // namespace

void set_manifold_maker(MakeManifoldMaker make) {
  maker_in_use.store(make, std::memory_order_release);
}

std::unique_ptr<ManifoldMaker> make_manifold_maker() {
  const MakeManifoldMaker make = maker_in_use.load(std::memory_order_acquire);
  if (make == nullptr)
    fail("manifolds are in the library supple::manifold; link it and call supple::use_manifolds() first");
  return make();
}

}  // namespace supple
