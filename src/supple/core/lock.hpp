#pragma once

#ifndef SUPPLE_SERIAL
#include <mutex>
#endif

namespace supple {

/// A mutex, and its lock for a scope. Without threads both do nothing.
#ifdef SUPPLE_SERIAL
class Mutex {};
class Lock {
 public:
  explicit Lock(Mutex&) {}
  ~Lock() {}  // so that the variable counts as used
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
};
#else
using Mutex = std::mutex;
using Lock = std::lock_guard<std::mutex>;
#endif

}  // namespace supple
