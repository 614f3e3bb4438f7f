#include "contest/turns.hpp"

#include <sched.h>

#include <algorithm>
#include <cstdio>

namespace supple::benchmarks {

void pin_to(int first, int count) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (int i = 0; i < count; ++i) CPU_SET(first + i, &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0)
    throw Error("cannot pin to processor " + std::to_string(first) + "; choose another by --cpu");
}

std::string text_of(const PairDigest& pairs) {
  char text[64];
  std::snprintf(text, sizeof text, "%llu pairs (hash %016llx)", static_cast<unsigned long long>(pairs.count),
                static_cast<unsigned long long>(pairs.hash));
  return text;
}

double quantile(std::vector<double> values, double part) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(part * last + 0.5);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

void check_equal(const std::string& cell, const Record& a, const Record& b) {
  if (a.pairs != b.pairs)
    throw Disagreement(cell + ": " + a.name + " finds " + text_of(a.pairs) + ", " + b.name + " " +
                       text_of(b.pairs));
}

}  // namespace supple::benchmarks
