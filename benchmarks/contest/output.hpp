#pragma once

#include <string>
#include <utility>
#include <vector>

#include "contest/contestant.hpp"

namespace supple::benchmarks {

/// The frames of one contestant.
struct Record {
  std::string name;
  unsigned threads = 1;
  std::vector<double> cpu, wall;
  std::vector<StageTime> stage_sums;
  PairDigest pairs;        ///< of its last frame
  PairDigest first_pairs;  ///< of the first counted frame, which is the same for all
};

void add_stages(Record& record, const std::vector<StageTime>& stages);

/// The JSON output of a cell: contestants, values, or the reason why it was skipped.
class Output {
 public:
  explicit Output(std::string cell) : cell_(std::move(cell)) {}
  void value(const std::string& name, double number);
  void skip(const std::string& reason) { skipped_ = reason; }
  void records(const std::vector<Record>& records);
  void print() const;

 private:
  std::string cell_, values_, contestants_, skipped_;
};

}  // namespace supple::benchmarks
