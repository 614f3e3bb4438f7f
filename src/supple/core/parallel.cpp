#include "core/parallel.hpp"

#include <algorithm>

namespace supple {

Parallel::Parallel(std::uint32_t threads) {
#if !defined(SUPPLE_SERIAL)
  if (threads == 0)
    threads = static_cast<std::uint32_t>(std::max(1, tbb::this_task_arena::max_concurrency()));
  worker_count_ = threads;
  if (threads > 1) arena_ = std::make_unique<tbb::task_arena>(static_cast<int>(threads));
#else
  (void)threads;
#endif
}

}  // namespace supple
