#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "reports/report.hpp"

namespace supple::cli {

struct Input;

/// Tables of continuous contacts: their number and earliest time per step, and the objects that touch.
class ImpactTables {
 public:
  void add(const Frame& step);
  /// Prints to standard output.
  void print(const Input& input) const;

 private:
  struct Counts {
    std::uint64_t vertex_face = 0;  ///< with the vertex in either object
    std::uint64_t edge_edge = 0;

    void add(const ContinuousContact& contact);
    std::uint64_t all() const { return vertex_face + edge_edge; }
  };
  struct Step {
    std::uint64_t number = 0;
    Counts counts;
    double earliest = 1;
  };
  struct Pair {
    std::uint64_t steps = 0;
    Counts counts;
  };

  void print_steps() const;
  void print_pairs(const Input& input) const;

  std::vector<Step> steps_;  ///< the first that have contacts
  std::uint64_t steps_with_contacts_ = 0;
  std::map<ObjectPair, Pair> pairs_;
  std::uint64_t within_tolerance_ = 0;
};

}  // namespace supple::cli
