#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>

namespace supple {

/// Tells workers which part of a search they can skip because enough contacts that come earlier in canonical
/// order were found already.
///
/// A place in that order is a number: the job, then 32 bits that the pass derives from the contact. The limit
/// only ever decreases, so a worker that reads an old value does too much, never too little.
class ContactLimit {
 public:
  static constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

  static std::uint64_t place(std::uint32_t job, std::uint32_t within) {
    return std::uint64_t{job} << 32 | within;
  }

  /// Call before a search for the first `most` contacts.
  void start(std::uint64_t most, std::size_t job_count) {
    wanted_ = most == unlimited ? unlimited : most + 1;
    last_.store(unlimited, std::memory_order_relaxed);
    if (!is_set()) return;
    if (capacity_ < job_count) {
      found_ = std::make_unique<std::atomic<std::uint64_t>[]>(job_count);
      capacity_ = job_count;
    }
    for (std::size_t job = 0; job < job_count; ++job) found_[job].store(0, std::memory_order_relaxed);
    job_count_ = job_count;
    total_.store(0, std::memory_order_relaxed);
    next_count_.store(wanted_, std::memory_order_relaxed);
  }

  bool is_set() const { return wanted_ != unlimited; }
  /// One more than requested, which shows whether there are more.
  std::uint64_t wanted() const { return wanted_; }
  /// Whether a list of `count` contacts is long enough to be worth cutting to `wanted()`.
  bool drops_at(std::size_t count) const { return count / 2 >= wanted_ && count >= 1024; }
  bool excludes(std::uint64_t place) const { return place > last_.load(std::memory_order_relaxed); }
  bool excludes_some() const { return last_.load(std::memory_order_relaxed) != unlimited; }

  /// `wanted()` contacts were found up to this place.
  void exclude_after(std::uint64_t place) {
    std::uint64_t last = last_.load(std::memory_order_relaxed);
    while (place < last && !last_.compare_exchange_weak(last, place, std::memory_order_relaxed)) {
    }
  }

  /// `count` more contacts of the job were found.
  void add(std::uint32_t job, std::uint64_t count) {
    if (!is_set() || count == 0) return;
    found_[job].fetch_add(count, std::memory_order_relaxed);
    const std::uint64_t total = total_.fetch_add(count, std::memory_order_relaxed) + count;
    std::uint64_t next = next_count_.load(std::memory_order_relaxed);
    // Sums up again each time the total has doubled.
    if (total < next || !next_count_.compare_exchange_strong(next, 2 * total)) return;
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < job_count_; ++i) {
      before += found_[i].load(std::memory_order_relaxed);
      if (before < wanted_) continue;
      exclude_after(place(static_cast<std::uint32_t>(i), ~std::uint32_t{0}));
      return;
    }
  }

 private:
  std::uint64_t wanted_ = unlimited;
  std::atomic<std::uint64_t> last_ = unlimited;
  std::unique_ptr<std::atomic<std::uint64_t>[]> found_;  // by job
  std::size_t capacity_ = 0, job_count_ = 0;
  std::atomic<std::uint64_t> total_ = 0, next_count_ = 0;
};

}  // namespace supple
