#pragma once

#include <algorithm>

namespace supple {

/// Sorts a list and keeps one of equal items.
template <class List>
void sort_once(List& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace supple
