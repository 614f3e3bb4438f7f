#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <vector>

#include "contest/cells/cells.hpp"

namespace supple::benchmarks {
namespace {

double milliseconds(const timeval& time) {
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
}

/// Runs `work` in a new process, and adds its times and the pairs that it returns to the record.
void run_in_process(const std::function<PairDigest()>& work, Record& record) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("cannot make a pipe");
  const double start = wall_milliseconds();
  const pid_t process = fork();
  if (process < 0) throw Error("cannot start a process");
  if (process == 0) {
    try {
      const PairDigest pairs = work();
      _exit(write(ends[1], &pairs, sizeof pairs) == sizeof pairs ? 0 : 1);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "supple_contest: %s\n", error.what());
      _exit(1);
    }
  }
  close(ends[1]);
  const bool is_read = read(ends[0], &record.pairs, sizeof record.pairs) == sizeof record.pairs;
  close(ends[0]);
  rusage usage{};
  wait4(process, nullptr, 0, &usage);
  if (!is_read) throw Error(record.name + " failed");
  record.first_pairs = record.pairs;
  record.cpu.push_back(milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime));
  record.wall.push_back(wall_milliseconds() - start);
}

template <class Workload, class AnyContestant>
PairDigest first_frame(AnyContestant& contestant, const Workload& workload) {
  contestant.prepare(workload);
  contestant.frame(workload);
  return contestant.pairs();
}

using Work = std::function<PairDigest()>;

/// Runs Supple and Embree in turn. `embree` is empty when the library was not found.
std::vector<Record> run_in_turn(const Choice& choice, const Work& supple, const Work& embree) {
  std::vector<Record> records(1);
  records[0].name = "Supple";
  if (embree && !choice.only_supple) records.emplace_back().name = "Embree";
  const double start = wall_milliseconds();
  while (records[0].cpu.size() < 3 ||
         (records[0].cpu.size() < choice.rounds && wall_milliseconds() - start < 1e3 * choice.seconds)) {
    for (Record& record : records) run_in_process(&record == records.data() ? supple : embree, record);
  }
  return records;
}

/// The first frame of Embree, or nothing when it is not among the entries.
template <class Entries, class MakeWorkload>
Work embree_frame(const Entries& entries, const MakeWorkload& make_workload) {
  for (const auto& entry : entries) {
    if (entry.name == "Embree") return [=] { return first_frame(*entry.make(), *make_workload()); };
  }
  return {};
}

}  // namespace

void run_first_frame(const Choice& choice, const std::string& name, Output& output) {
  if (name.find('x') != std::string::npos) {
    const auto copies = make_deforming_copies(name);
    if (!copies) return output.skip("the bunny is not there; set SUPPLE_DATA");
    const auto same_copies = [&] { return &*copies; };
    const auto records = run_in_turn(
        choice, [&] { return first_frame(*make_supple_copies(1), *copies); },
        embree_frame(other_copies_contestants(), same_copies));
    for (const Record& record : records) check_equal(choice.cell, records.front(), record);
    return output.records(records);
  }
  const auto load_step = [name] { return make_cloth_step(name); };
  if (!load_step()) return output.skip("the frames of " + name + " are not there; set SUPPLE_DATA");
  output.records(run_in_turn(
      choice, [&] { return first_frame(*make_supple_cloth(1), *load_step()); },
      embree_frame(other_cloth_contestants(), load_step)));
}

}  // namespace supple::benchmarks
