#include "answers/penetration/manifold_methods.hpp"

#include <atomic>

#include "core/error.hpp"

namespace supple {
namespace {

std::atomic<const ManifoldMethods*> methods_in_use = nullptr;

}  // namespace

void set_manifold_methods(const ManifoldMethods& methods) {
  methods_in_use.store(&methods, std::memory_order_release);
}

const ManifoldMethods& manifold_methods(const std::string& what) {
  const ManifoldMethods* const methods = methods_in_use.load(std::memory_order_acquire);
  if (methods == nullptr)
    fail(what + " are in the library supple::manifold; link it and call supple::use_manifolds() first");
  return *methods;
}

}  // namespace supple
