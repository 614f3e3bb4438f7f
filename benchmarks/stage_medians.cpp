// Runs Supple alone on cells of workloads A, B and C and prints the median time of each stage. Options are
// the defaults; `--pairs-only` leaves out contact points and normals.
//
//     supple_stage_medians 18000x64 bunnyx9 cloth-ball u1/100000 --frames 20 --threads 1

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"
#include "workloads/cloth_steps.hpp"
#include "workloads/deforming_copies.hpp"
#include "workloads/moving_boxes.hpp"

namespace supple::benchmarks {
namespace {

struct Choice {
  std::vector<std::string> cells;
  std::size_t frames = 15;
  std::uint32_t threads = 1;
  bool pairs_only = false;
};

/// Processor time of the calling process in milliseconds.
double cpu_milliseconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Milliseconds of each stage, one row per frame.
class StageTimes {
 public:
  void add(const StepStats& stats, double set_milliseconds, double cpu) {
    const double seconds[] = {stats.refit_seconds, stats.broad_phase_seconds,     stats.traversal_seconds,
                              stats.exact_seconds, stats.sort_and_events_seconds, stats.total_seconds};
    rows_[0].push_back(set_milliseconds);
    for (std::size_t i = 0; i < std::size(seconds); ++i) rows_[i + 1].push_back(1e3 * seconds[i]);
    rows_[7].push_back(cpu);
  }
  void print(const std::string& cell, const StepStats& last) const {
    std::printf("%-16s", cell.c_str());
    for (const auto& row : rows_) std::printf(" %9.3f", median(row));
    const auto candidates = last.candidate_pairs + last.vertex_face_candidates + last.edge_edge_candidates;
    std::printf(" %11llu %9llu %9llu\n", static_cast<unsigned long long>(candidates),
                static_cast<unsigned long long>(last.contacts),
                static_cast<unsigned long long>(last.exact_fallbacks));
  }
  static void print_heading() {
    std::printf("%-16s %9s %9s %9s %9s %9s %9s %9s %9s %11s %9s %9s\n", "ms", "set", "refit", "broad",
                "traverse", "exact", "finish", "detect", "cpu", "candidates", "contacts", "fallbacks");
  }

 private:
  std::vector<double> rows_[8];
};

template <class Move>
void time_frames(const std::string& cell, const Choice& choice, Scene& scene, Move move) {
  StageTimes times;
  for (std::size_t frame = 0; frame < choice.frames + 2; ++frame) {
    const double set = move();
    const double before = cpu_milliseconds();
    const StepStats& stats = scene.detect().stats;
    const double cpu = cpu_milliseconds() - before + set;
    if (frame >= 2) times.add(stats, set, cpu);  // the first frames still grow the buffers
  }
  times.print(cell, scene.result().stats);
}

bool run_copies(const std::string& cell, const Choice& choice) {
  auto copies = make_deforming_copies(cell);
  if (!copies) return false;
  SceneOptions options;
  options.threads = choice.threads;
  options.contact_points = !choice.pairs_only;
  Scene scene(options);
  std::vector<ObjectId> objects;
  for (std::size_t i = 0; i < copies->copies(); ++i)
    objects.push_back(scene.add(copies->positions(i), copies->triangles()));
  time_frames(cell, choice, scene, [&] {
    copies->advance();
    const double before = cpu_milliseconds();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (copies->moves(i)) scene.share_positions(objects[i], copies->positions(i));
    }
    return cpu_milliseconds() - before;
  });
  return true;
}

bool run_cloth(const std::string& cell, const Choice& choice) {
  const auto step = make_cloth_step(cell);
  if (!step) return false;
  SceneOptions options;
  options.threads = choice.threads;
  options.contacts = ContactKinds::continuous;
  Scene scene(options);
  const ObjectId cloth = scene.add(step->start, step->triangles, {.self_collision = true});
  time_frames(cell, choice, scene, [&] {
    const double before = cpu_milliseconds();
    scene.set_motion(cloth, step->start, step->end);
    return cpu_milliseconds() - before;
  });
  return true;
}

void run_boxes(const std::string& cell, const Choice& choice) {
  const std::size_t slash = cell.find('/');
  const std::size_t count = std::strtoull(cell.c_str() + slash + 1, nullptr, 10);
  MovingBoxes field(cell.substr(0, slash), count);
  BroadPhaseOptions options;
  options.threads = choice.threads;
  BroadPhase broad_phase(options);
  std::vector<double> times;
  std::size_t pairs = 0;
  for (std::size_t frame = 0; frame < choice.frames + 2; ++frame) {
    field.advance();
    const double before = cpu_milliseconds();
    pairs = broad_phase.find_object_pairs(field.boxes()).size();
    if (frame >= 2) times.push_back(cpu_milliseconds() - before);
  }
  std::printf("%-16s %69s %9.3f %9s %9zu\n", cell.c_str(), "", median(times), "", pairs);
}

void run(const Choice& choice) {
  StageTimes::print_heading();
  for (const std::string& cell : choice.cells) {
    bool there = true;
    if (cell.find('/') != std::string::npos)
      run_boxes(cell, choice);
    else if (cell.find('x') != std::string::npos)
      there = run_copies(cell, choice);
    else
      there = run_cloth(cell, choice);
    if (!there) std::printf("%-16s left out: its files are not there; set SUPPLE_DATA\n", cell.c_str());
    std::fflush(stdout);
  }
}

std::size_t number_of(std::string_view text) {
  std::size_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  if (number == 0) throw Error("'" + std::string(text) + "' is not a number above 0");
  return number;
}

Choice choice_of(int argument_count, char** arguments) {
  Choice choice;
  for (int i = 1; i < argument_count; ++i) {
    const std::string argument = arguments[i];
    const bool has_value = i + 1 < argument_count;
    if (argument == "--frames" && has_value)
      choice.frames = number_of(arguments[++i]);
    else if (argument == "--threads" && has_value)
      choice.threads = static_cast<std::uint32_t>(number_of(arguments[++i]));
    else if (argument == "--pairs-only")
      choice.pairs_only = true;
    else if (argument.starts_with("-"))
      throw Error("usage: supple_stage_medians [--frames N] [--threads N] [--pairs-only] [CELL...]");
    else
      choice.cells.push_back(argument);
  }
  if (choice.cells.empty())
    choice.cells = {"980x64",  "980x512",       "18000x9",      "18000x64",   "69620x9", "69620x64",
                    "bunnyx9", "18000x64-rest", "cloth-funnel", "cloth-ball", "crumpled"};
  return choice;
}

}  // namespace
}  // namespace supple::benchmarks

int main(int argument_count, char** arguments) {
  try {
    supple::benchmarks::run(supple::benchmarks::choice_of(argument_count, arguments));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "supple_stage_medians: %s\n", error.what());
    return 1;
  }
  return 0;
}
