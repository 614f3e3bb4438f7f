#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace supple {

/// Owns lists of a result after the scene has gone on. First `keep` all lists, which copies them, then call
/// `swap` and `keep` the same lists in the same order: the scene has the copies from then on, and the
/// addresses that users know stay valid here. So a lack of memory, which only copying can meet, changes
/// nothing.
class KeptLists {
 public:
  template <class Row>
  void keep(std::vector<Row>& list) {
    if (swaps_)
      static_cast<std::vector<Row>*>(lists_[next_++].get())->swap(list);
    else
      lists_.push_back(std::make_shared<std::vector<Row>>(list));
  }
  void swap() { swaps_ = true; }

 private:
  std::vector<std::shared_ptr<void>> lists_;
  std::size_t next_ = 0;
  bool swaps_ = false;
};

}  // namespace supple
