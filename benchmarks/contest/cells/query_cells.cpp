#include <cmath>

#include "contest/cells/cells.hpp"

namespace supple::benchmarks {
namespace {

/// Peers in single precision miss a ray along an edge now and then, and round distances.
constexpr double tolerance = 1e-3, most_others = 1e-4;

void check_answers(const std::string& cell, const std::string& name, std::span<const double> expected,
                   std::span<const double> found) {
  if (expected.size() != found.size())
    throw Disagreement(cell + ": " + name + " has " + std::to_string(found.size()) + " answers, Supple " +
                       std::to_string(expected.size()));
  std::size_t others = 0;
  double largest = 0;
  for (const double x : expected) largest = std::max(largest, std::isfinite(x) ? std::fabs(x) : 0);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool is_equal = expected[i] == found[i] || std::fabs(expected[i] - found[i]) <= tolerance * largest;
    others += is_equal ? 0 : 1;
  }
  if (static_cast<double>(others) > most_others * static_cast<double>(expected.size()))
    throw Disagreement(cell + ": " + name + " has " + std::to_string(others) + " other answers than Supple");
}

}  // namespace

void run_queries(const Choice& choice, const std::string& name, Output& output) {
  auto task = make_query_task(name);
  if (!task) return output.skip("the bunny is not there; set SUPPLE_DATA");
  output.value("triangles", static_cast<double>(task->copies.triangle_count()));
  Turns<QueryTask, QueryContestant> turns;
  turns.add("Supple", 1, make_supple_queries(1), *task);
  if (!choice.only_supple) {
    for (const auto& entry : other_query_contestants()) {
      auto contestant = entry.make();
      if (contestant->answers_kind(task->kind)) turns.add(entry.name, 1, std::move(contestant), *task);
    }
  }
  turns.run(
      choice, *task, [&] { task->advance(); },
      [&](const std::vector<std::size_t>& ran, const auto& contestants, const std::vector<Record>& records) {
        if (ran.empty() || std::find(ran.begin(), ran.end(), 0u) == ran.end()) return;
        for (const std::size_t i : ran) {
          std::vector<double> answers(contestants[i]->answers().begin(), contestants[i]->answers().end());
          if (records[i].name == choice.spoiled) answers.pop_back();
          check_answers(choice.cell, records[i].name, contestants[0]->answers(), answers);
        }
      });
  output.records(turns.records());
}

}  // namespace supple::benchmarks
