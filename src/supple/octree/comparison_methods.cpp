#include "octree/comparison_methods.hpp"

#include <atomic>

#include "core/error.hpp"

namespace supple {
namespace {

std::atomic<const ComparisonMethods*> methods_in_use = nullptr;

}  // namespace

void set_comparison_methods(const ComparisonMethods& methods) {
  methods_in_use.store(&methods, std::memory_order_release);
}

const ComparisonMethods& comparison_methods(const std::string& option) {
  const ComparisonMethods* const methods = methods_in_use.load(std::memory_order_acquire);
  if (methods == nullptr)
    fail(option +
         " is in the library supple::comparison; link it and call supple::use_comparison_methods() first");
  return *methods;
}

}  // namespace supple
