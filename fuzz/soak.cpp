// Soak test: runs a scene file for many frames, as `supple simulate` does, and checks in each frame what must
// always hold. Prints a row of CSV every --row-every frames. soak.py runs all scenes and judges the memory.

#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <source_location>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "commands/build_simulation.hpp"
#include "scene_file/scene_file.hpp"
#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/recording.hpp"
#include "supple/simulation.hpp"
#include "supple/verify.hpp"
#include "support/check.hpp"
#include "support/event_ledger.hpp"

namespace {

using namespace supple;
using Clock = std::chrono::steady_clock;

/// Bytes that recordings leave free on a disk.
constexpr std::uintmax_t least_free = std::uintmax_t{1} << 30;

struct Options {
  std::string scene;
  std::uint64_t frames = 1'000'000;
  double seconds = std::numeric_limits<double>::infinity();
  std::uint64_t row_every = 1000, check_every = 10'000, replace_every = 0;
  std::string record;
  std::uint64_t record_frames = 5000;
  std::uint32_t threads = 1;
};

struct Memory {
  std::uint64_t resident = 0;  ///< bytes of the process in physical memory
  std::uint64_t heap = 0;      ///< bytes that were allocated and not freed; 0 with address sanitizer
};

Memory measure_memory() {
  std::uint64_t size = 0, pages = 0;
  std::ifstream("/proc/self/statm") >> size >> pages;
  const struct mallinfo2 heap = mallinfo2();
  return {pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)), heap.uordblks + heap.hblkhd};
}

/// Whether the groups of a result are of the active pairs, and of objects with themselves.
bool are_of(const std::set<ObjectPair>& active, std::span<const ContactGroup> groups) {
  auto pair = active.begin();
  for (const ContactGroup& group : groups) {
    if (group.a == group.b) continue;
    if (pair == active.end() || *pair != ObjectPair{group.a, group.b}) return false;
    ++pair;
  }
  return pair == active.end();
}

std::size_t change_count(const PairEvents& events) {
  return events.begin.size() + events.end.size();
}

cli::Input read_input(const Options& options) {
  cli::Input input = cli::read_scene_file(options.scene);
  input.simulation.scene.threads = options.threads;
  return input;
}

class Soak {
 public:
  explicit Soak(const Options& options)
      : options_(options),
        input_(read_input(options)),
        simulation_(cli::build_simulation(input_)),
        ids_(simulation_.scene().objects()) {}

  void run() {
    std::puts(
        "frame,seconds,resident,heap,contacts,proximity_pairs,object_pairs,events,checked,"
        "replaced,recordings");
    begin_recording();
    take(simulation_.detect());
    while (frame_ < options_.frames && seconds() < options_.seconds) {
      if (is_due(options_.replace_every)) replace_object();
      ++frame_;
      take(simulation_.step());
    }
    if (frame_ % options_.row_every != 0) print_row();
    end_recording();
    check_end();
  }

 private:
  bool is_due(std::uint64_t interval) const { return interval > 0 && frame_ > 0 && frame_ % interval == 0; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  void check(bool holds, std::string_view what,
             const std::source_location& place = std::source_location::current()) const {
    if (!holds) fuzz::check(false, "frame " + std::to_string(frame_) + ": " + std::string(what), place);
  }

  void take(const DetectResult& result) {
    check_events(result);
    check_objects();
    if (is_due(options_.check_every)) check_thoroughly();
    record(result);
    if (frame_ % options_.row_every == 0) print_row();
  }

  void check_thoroughly() {
    const Scene& scene = simulation_.scene();
    const std::string error = SceneInspector(scene).validate();
    check(error.empty(), error);
    check(verify(scene).agrees(), "the result differs from that of brute force");
    ++checked_;
  }

  void check_events(const DetectResult& result) {
    ledgers_.apply(result);
    const auto& pairs = ledgers_.volumes.active();
    check(std::equal(pairs.begin(), pairs.end(), result.object_pairs.begin(), result.object_pairs.end()),
          "the events leave other object pairs than the result has");
    // Events of contacts also count continuous contacts, which have groups of their own.
    const bool is_continuous = contains(input_.simulation.scene.contacts, ContactKinds::continuous);
    check(is_continuous || are_of(ledgers_.contacts.active(), result.groups),
          "the events leave other pairs in contact than the result has");
    check(are_of(ledgers_.proximity.active(), result.proximity_groups),
          "the events leave other pairs in proximity than the result has");
    for (const PairEvents& events :
         {result.volume_events, result.contact_events, result.proximity_events, result.penetration_events})
      events_ += change_count(events);
  }

  void check_objects() const {
    std::vector<ObjectId> sorted = ids_;
    std::sort(sorted.begin(), sorted.end());
    check(simulation_.scene().objects() == sorted, "the scene has other objects than were added");
    for (const ObjectId id : ids_) {
      for (const Vec3d& p : simulation_.positions(id))
        check(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "a position is not finite");
    }
  }

  /// Removes an object and adds it again where it is, one object after the other.
  void replace_object() {
    const std::size_t place = replaced_++ % ids_.size();
    const cli::InputObject& object = input_.objects[place];
    ObjectId& id = ids_[place];
    const ObjectId old = id;
    const std::span<const Vec3d> positions = simulation_.positions(old);
    const std::vector<Vec3d> kept(positions.begin(), positions.end());
    simulation_.remove(old);
    check(!simulation_.scene().contains(old), "the scene has an object that was removed");
    id = cli::add_object(simulation_, object);
    check(id.index == old.index && id.generation > old.generation,
          "the id of a removed object is used again");
    if (keeps_place(object)) simulation_.set_positions(id, kept);
  }

  /// Objects that a function moves return by themselves. Handles would pull an object further each time, so
  /// it starts again.
  static bool keeps_place(const cli::InputObject& object) {
    if (!object.motion) return !object.options.is_static;
    if (const auto* springs = std::get_if<MassSpringMotion>(&*object.motion)) return springs->handles.empty();
    return std::holds_alternative<RigidMotion>(*object.motion);
  }

  void begin_recording() {
    recorded_ = 0;
    if (options_.record.empty()) return;
    recorded_ids_ = simulation_.scene().objects();
    RecordingHeader header;
    header.time_step = input_.simulation.time_step;
    header.scene = input_.simulation.scene;
    header.scene_file = input_.scene_text;
    for (std::size_t i = 0; i < recorded_ids_.size(); ++i)
      header.objects.push_back(
          cli::recorded_object(recorded_ids_[i], input_.objects[i], input_.simulation.border));
    recorder_.emplace(options_.record, header);
  }

  /// A file with some frames replaces the one before, so that the disk does not fill.
  void record(const DetectResult& result) {
    if (!recorder_) return;
    if (frame_ % options_.row_every == 0) check_disk();
    positions_.clear();
    for (const ObjectId id : recorded_ids_) positions_.push_back(simulation_.positions(id));
    recorder_->add(simulation_.time(), positions_, result);
    if (++recorded_ < options_.record_frames) return;
    end_recording();
    begin_recording();
  }

  void check_disk() const {
    namespace fs = std::filesystem;
    if (fs::space(fs::absolute(options_.record).parent_path()).available < least_free)
      throw Error("--record " + options_.record +
                  ": its disk has less than 1 GiB left; make room or give fewer --record-frames");
  }

  void end_recording() {
    if (!recorder_) return;
    recorder_->close();
    recorder_.reset();
    check(Recording(options_.record).frame_count() == recorded_, "a recording has lost frames");
    ++recordings_;
  }

  void check_end() {
    for (const ObjectId id : ids_) simulation_.remove(id);
    const DetectResult& result = simulation_.detect();
    ledgers_.apply(result);
    for (const fuzz::EventLedger* ledger :
         {&ledgers_.volumes, &ledgers_.contacts, &ledgers_.proximity, &ledgers_.penetration})
      check(ledger->active().empty(), "a pair did not end when its objects were removed");
  }

  void print_row() const {
    const Memory memory = measure_memory();
    const DetectResult& result = simulation_.scene().result();
    std::printf("%ju,%.3f,%ju,%ju,%zu,%zu,%zu,%ju,%ju,%ju,%ju\n", std::uintmax_t{frame_}, seconds(),
                std::uintmax_t{memory.resident}, std::uintmax_t{memory.heap}, result.contacts.size(),
                result.proximity_pairs.size(), result.object_pairs.size(), std::uintmax_t{events_},
                std::uintmax_t{checked_}, std::uintmax_t{replaced_}, std::uintmax_t{recordings_});
    std::fflush(stdout);
  }

  const Options& options_;
  cli::Input input_;
  Simulation simulation_;
  std::vector<ObjectId> ids_;  // in the order of the input
  fuzz::EventLedgers ledgers_;
  std::optional<Recorder> recorder_;
  std::vector<ObjectId> recorded_ids_;
  std::vector<std::span<const Vec3d>> positions_;
  Clock::time_point start_ = Clock::now();
  std::uint64_t frame_ = 0, events_ = 0, checked_ = 0, replaced_ = 0;
  std::uint64_t recorded_ = 0, recordings_ = 0;  // frames in the present file, and complete files
};

}  // namespace

int main(int count, char** arguments) {
  Options options;
  CLI::App app("Runs a scene file for many frames and checks events, ids, positions and invariants");
  app.add_option("SCENE.toml", options.scene, "A scene file")->required();
  app.add_option("--frames", options.frames, "Number of frames")->capture_default_str();
  app.add_option("--seconds", options.seconds, "Stop after this time, also before all frames");
  const auto add_interval = [&](const char* name, std::uint64_t& interval, const char* what) {
    return app.add_option(name, interval, what)->capture_default_str();
  };
  add_interval("--row-every", options.row_every, "Frames from row to row")->check(CLI::PositiveNumber);
  add_interval("--check-every", options.check_every,
               "Frames between checks of every invariant and comparisons with brute force; 0: none");
  CLI::Option* const replace =
      add_interval("--replace-every", options.replace_every,
                   "Frames after which an object is removed and added again, in turn; 0: none");
  app.add_option("--record", options.record, "Record to this HDF5 file; when it is full, start it again")
      ->excludes(replace);
  add_interval("--record-frames", options.record_frames, "Frames after which the file is full")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "Number of threads; 0: one per core")->capture_default_str();
  CLI11_PARSE(app, count, arguments);
  try {
    Soak(options).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", options.scene.c_str(), error.what());
    return 1;
  }
  return 0;
}
