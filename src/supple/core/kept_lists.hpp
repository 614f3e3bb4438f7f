#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace supple {

/// Owns lists of a result after the scene has gone on. First `copy` each list, then `swap` the same lists in
/// the same order: the scene has the copies from then on, and the addresses that users know stay valid here.
/// So a lack of memory, which only `copy` can meet, changes nothing.
class KeptLists {
 public:
  template <class Row>
  void copy(const std::vector<Row>& list) {
    lists_.push_back(std::make_shared<std::vector<Row>>(list));
  }
  template <class Row>
  void swap(std::vector<Row>& list) {
    static_cast<std::vector<Row>*>(lists_[next_++].get())->swap(list);
  }

 private:
  std::vector<std::shared_ptr<void>> lists_;
  std::size_t next_ = 0;
};

}  // namespace supple
