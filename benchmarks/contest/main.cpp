// Runs one cell of the contest: all contestants on one workload, frame by frame in turn. Prints their times
// as JSON. benchmarks/contest.py runs the cells and makes the tables.

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "contest/cells/cells.hpp"
#include "supple/comparison.hpp"
#include "supple/use_manifolds.hpp"

namespace supple::benchmarks {
namespace {

constexpr const char* usage =
    "usage: supple_contest [--seconds S] [--rounds N] [--cpu N] [--only-supple] [--instruction-set SET] "
    "[--spoil NAME] CELL | --missing\n"
    "CELL: A/FIELD/N  A/FIELD/N/drift  A/FIELD/N/one-percent  A/FIELD/N/one-in-K\n"
    "      B/SHAPExCOPIES[-rest]  C/CLOTH  E/CLOTH  P/CLOTH\n"
    "      Q/closest/SHAPE-uniform  Q/closest/SHAPE-near  Q/inside/SHAPE  Q/rays/SHAPExCOPIES  "
    "Q/penetration/SHAPE[-deep]  Q/distance/SHAPE-apart  Q/distance/SHAPE-near\n"
    "      step/CLOTH  growth/SHAPExCOPIES  threads/B/...  threads/C/...  limits/bandwidth  "
    "limits/refit/TRIANGLES  "
    "memory/SHAPE  memory/moving/SHAPE  build/SHAPE  scale/TRIANGLES  frames/SHAPExCOPIES  "
    "frames/surgery  edit/organ  first/SHAPExCOPIES  first/CLOTH\n"
    "      game/penetration  game/proximity\n"
    "FIELD: u1 u8 clu cl8   SHAPE: 980, 18000, 69620, ... or bunny   CLOTH: cloth-ball cloth-funnel "
    "crumpled passing rods\n"
    "SET: avx512 avx2 sse4, for Supple and Embree\n";

void run(const Choice& choice) {
  const std::string& cell = choice.cell;
  Output output(cell);
  const auto after = [&](std::string_view prefix) { return cell.substr(prefix.size()); };
  const bool two_threads = cell.starts_with("threads/");
  if (two_threads)
    pin_to(0, 2);
  else if (cell.starts_with("build/"))
    pin_to(0, 2);
  else if (!cell.starts_with("limits/bandwidth"))
    pin_to(choice.cpu, 1);
  if (cell.starts_with("A/")) {
    run_boxes(choice, after("A/"), output);
  } else if (cell.starts_with("B/")) {
    run_copies(choice, after("B/"), false, output);
  } else if (cell.starts_with("growth/")) {
    Choice alone = choice;
    alone.only_supple = true;
    run_copies(alone, after("growth/"), false, output);
  } else if (cell.starts_with("C/")) {
    run_cloth(choice, after("C/"), false, output);
  } else if (cell.starts_with("E/")) {
    run_cloth_boxes(choice, after("E/"), output);
  } else if (cell.starts_with("P/")) {
    run_near_cloth(choice, after("P/"), output);
  } else if (cell.starts_with("Q/")) {
    run_queries(choice, after("Q/"), output);
  } else if (cell.starts_with("step/")) {
    run_safe_step(choice, after("step/"), output);
  } else if (cell.starts_with("threads/B/")) {
    run_copies(choice, after("threads/B/"), true, output);
  } else if (cell.starts_with("threads/C/")) {
    run_cloth(choice, after("threads/C/"), true, output);
  } else if (cell == "limits/bandwidth") {
    run_bandwidth(output);
  } else if (cell.starts_with("limits/refit/")) {
    run_refit(choice, after("limits/refit/"), output);
  } else if (cell.starts_with("memory/moving/")) {
    run_memory(after("memory/moving/"), true, output);
  } else if (cell.starts_with("memory/")) {
    run_memory(after("memory/"), false, output);
  } else if (cell.starts_with("build/")) {
    run_build(choice, after("build/"), output);
  } else if (cell.starts_with("scale/")) {
    run_scale(choice, after("scale/"), output);
  } else if (cell.starts_with("first/")) {
    run_first_frame(choice, after("first/"), output);
  } else if (cell.starts_with("game/")) {
    run_game(choice, after("game/"), output);
  } else if (cell == "edit/organ") {
    run_cutting(choice, output);
  } else if (cell == "frames/surgery") {
    run_surgery(choice, output);
  } else if (cell.starts_with("frames/")) {
    run_frames(choice, after("frames/"), output);
  } else {
    throw Error("no cell is named '" + cell + "'\n" + usage);
  }
  output.print();
}

double number_of(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(number >= 0)) throw Error("'" + text + "' is not a number\n" + usage);
  return number;
}

Choice choice_of(const std::vector<std::string>& words) {
  Choice choice;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool has_value = i + 1 < words.size();
    if (words[i] == "--seconds" && has_value)
      choice.seconds = number_of(words[++i]);
    else if (words[i] == "--rounds" && has_value)
      choice.rounds = static_cast<std::size_t>(number_of(words[++i]));
    else if (words[i] == "--cpu" && has_value)
      choice.cpu = static_cast<int>(number_of(words[++i]));
    else if (words[i] == "--spoil" && has_value)
      choice.spoiled = words[++i];
    else if (words[i] == "--instruction-set" && has_value)
      limit_instruction_set(words[++i]);
    else if (words[i] == "--only-supple")
      choice.only_supple = true;
    else if (words[i].starts_with("-") || !choice.cell.empty())
      throw Error(usage);
    else
      choice.cell = words[i];
  }
  if (choice.cell.empty()) throw Error(usage);
  return choice;
}

}  // namespace
}  // namespace supple::benchmarks

/// Returns 0 on success, 1 for wrong usage, 3 when contestants disagree.
int main(int argument_count, char** arguments) {
  using namespace supple::benchmarks;
  supple::use_comparison_methods();
  supple::use_manifolds();
  const std::vector<std::string> words(arguments + 1, arguments + argument_count);
  try {
    if (words == std::vector<std::string>{"--missing"}) {
      for (const std::string& library : missing_libraries()) std::puts(library.c_str());
      return 0;
    }
    run(choice_of(words));
  } catch (const Disagreement& error) {
    std::fprintf(stderr, "supple_contest: %s\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "supple_contest: %s\n", error.what());
    return 1;
  }
  return 0;
}
