// One cell of the contest: all contestants on one workload, frame by frame in turn, and their times as JSON.
// benchmarks/contest.py runs the cells and makes tables of them.

#include <malloc.h>
#include <sched.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "contest/contestant.hpp"
#include "contest/limits.hpp"
#include "supple/continuous.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/version.hpp"

namespace supple::benchmarks {
namespace {

constexpr const char* usage =
    "usage: supple_contest [--seconds S] [--rounds N] [--cpu N] [--only-supple] CELL | --missing\n"
    "CELL: A/FIELD/N  A/FIELD/N/drift  A/FIELD/N/one-percent  B/SHAPExCOPIES[-rest]  C/CLOTH\n"
    "      growth/SHAPExCOPIES  threads/B/...  threads/C/...  limits/bandwidth  limits/refit/TRIANGLES  "
    "memory/SHAPE\n"
    "FIELD: u1 u8 clu cl8   SHAPE: 980, 18000, 69620, ... or bunny   CLOTH: cloth-ball cloth-funnel "
    "crumpled\n";

struct Choice {
  std::string cell;
  double seconds = 3;       ///< that rounds begin in, at least three of them
  std::size_t rounds = 60;  ///< at most
  int cpu = 0;              ///< to which one thread is pinned
  bool only_supple = false;
};

/// Wrong pairs, not wrong use.
struct Disagreement : Error {
  using Error::Error;
};

/// One contestant's frames.
struct Record {
  std::string name;
  unsigned threads = 1;
  std::vector<double> cpu, wall;
  std::vector<StageTime> stage_sums;
  PairDigest pairs;        ///< of the last frame it ran
  PairDigest first_pairs;  ///< of the first that counts, which is the same for all
};

void add_stages(Record& record, const std::vector<StageTime>& stages) {
  if (record.stage_sums.empty())
    record.stage_sums = stages;
  else
    for (std::size_t i = 0; i < stages.size(); ++i)
      record.stage_sums[i].cpu_milliseconds += stages[i].cpu_milliseconds;
}

std::string json_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string list_of(const std::vector<double>& values) {
  std::string text;
  char number[32];
  for (const double value : values) {
    std::snprintf(number, sizeof number, "%s%.6g", text.empty() ? "" : ", ", value);
    text += number;
  }
  return '[' + text + ']';
}

/// What a cell writes: an object with contestants, values, or why there is neither.
class Output {
 public:
  explicit Output(std::string cell) : cell_(std::move(cell)) {}
  void value(const std::string& name, double number) {
    char text[64];
    std::snprintf(text, sizeof text, "%.8g", number);
    values_ += (values_.empty() ? "" : ", ") + json_string(name) + ": " + text;
  }
  void skip(const std::string& reason) { skipped_ = reason; }
  void records(const std::vector<Record>& records) {
    for (const Record& record : records) {
      std::string stages;
      const auto frames = static_cast<double>(std::max<std::size_t>(record.cpu.size(), 1));
      for (const StageTime& stage : record.stage_sums) {
        char number[32];
        std::snprintf(number, sizeof number, "%.6g", stage.cpu_milliseconds / frames);
        stages += (stages.empty() ? "" : ", ") + json_string(stage.name) + ": " + number;
      }
      char hash[24];
      std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(record.first_pairs.hash));
      contestants_ += (contestants_.empty() ? "\n  " : ",\n  ") + std::string("{\"name\": ") +
                      json_string(record.name) + ", \"threads\": " + std::to_string(record.threads) +
                      ", \"pairs\": " + std::to_string(record.first_pairs.count) + ", \"hash\": \"" + hash +
                      "\", \"cpu_ms\": " + list_of(record.cpu) + ", \"wall_ms\": " + list_of(record.wall) +
                      ", \"mean_stage_ms\": {" + stages + "}}";
    }
  }
  void print() const {
    std::printf(
        "{\"cell\": %s, \"version\": \"%s\", \"skipped\": %s,\n \"values\": {%s},\n \"contestants\": [%s]}\n",
        json_string(cell_).c_str(), SUPPLE_VERSION, skipped_.empty() ? "null" : json_string(skipped_).c_str(),
        values_.c_str(), contestants_.c_str());
  }

 private:
  std::string cell_, values_, contestants_, skipped_;
};

void pin_to(int first, int count) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (int i = 0; i < count; ++i) CPU_SET(first + i, &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0)
    throw Error("cannot pin to processor " + std::to_string(first) + "; choose another by --cpu");
}

/// Frames in turn: the first contestant first, in the next round the second, and so on round.
template <class Workload, class AnyContestant>
class Turns {
 public:
  void add(std::string name, unsigned threads, std::unique_ptr<AnyContestant> contestant,
           const Workload& workload) {
    contestant->prepare(workload);
    contestants_.push_back(std::move(contestant));
    Record record;
    record.name = std::move(name);
    record.threads = threads;
    records_.push_back(std::move(record));
  }

  /// `advance` makes the next frame; `check` sees each round's contestants that ran.
  template <class Advance, class Check>
  void run(const Choice& choice, const Workload& workload, Advance advance, Check check) {
    const double start = wall_milliseconds(), budget = 1e3 * choice.seconds;
    const std::size_t count = contestants_.size();
    std::vector<double> spent(count, 0);
    // Who takes more than its share of the time has only the first few frames.
    const auto has_share = [&](std::size_t i) {
      return records_[i].cpu.size() < fewest || spent[i] < budget / static_cast<double>(count);
    };
    for (std::size_t round = 0; round < warm_up + choice.rounds; ++round) {
      const bool is_measured = round >= warm_up;
      const bool is_late = wall_milliseconds() - start > 3 * budget;  // the frames take time to make, too
      std::vector<std::size_t> running;
      for (std::size_t turn = 0; turn < count; ++turn) {
        const std::size_t i = (turn + round) % count;
        if (has_share(i) && !(is_late && records_[i].cpu.size() >= fewest)) running.push_back(i);
      }
      if (running.empty()) break;
      advance();
      for (const std::size_t i : running) spent[i] += time_frame(i, workload, is_measured);
      check(running, contestants_, records_);
    }
  }
  std::vector<Record>& records() { return records_; }

 private:
  static constexpr std::size_t warm_up = 2, fewest = 3;

  double time_frame(std::size_t i, const Workload& workload, bool is_measured) {
    const double wall = wall_milliseconds(), cpu = cpu_milliseconds();
    contestants_[i]->frame(workload);
    const double cpu_spent = cpu_milliseconds() - cpu, wall_spent = wall_milliseconds() - wall;
    Record& record = records_[i];
    record.pairs = contestants_[i]->pairs();
    if (is_measured) {
      if (record.cpu.empty()) record.first_pairs = record.pairs;
      record.cpu.push_back(cpu_spent);
      record.wall.push_back(wall_spent);
      add_stages(record, contestants_[i]->stages());
    }
    return wall_spent;
  }

  std::vector<std::unique_ptr<AnyContestant>> contestants_;
  std::vector<Record> records_;
};

std::string text_of(const PairDigest& pairs) {
  char text[64];
  std::snprintf(text, sizeof text, "%llu pairs (hash %016llx)", static_cast<unsigned long long>(pairs.count),
                static_cast<unsigned long long>(pairs.hash));
  return text;
}

void check_equal(const std::string& cell, const Record& a, const Record& b) {
  if (a.pairs != b.pairs)
    throw Disagreement(cell + ": " + a.name + " finds " + text_of(a.pairs) + ", " + b.name + " " +
                       text_of(b.pairs));
}

/// All that ran in a round found the same.
auto same_pairs(const std::string& cell) {
  return [cell](const std::vector<std::size_t>& ran, const auto&, const std::vector<Record>& records) {
    for (const std::size_t i : ran) check_equal(cell, records[ran.front()], records[i]);
  };
}

// --- workload A ---

struct BoxCell {
  std::string field, variant;
  std::size_t count = 0;
};

BoxCell box_cell_of(const std::string& text) {  // after "A/"
  BoxCell cell;
  const std::size_t slash = text.find('/'), second = text.find('/', slash + 1);
  cell.field = text.substr(0, slash);
  if (slash != std::string::npos) {
    const std::string number =
        text.substr(slash + 1, second == std::string::npos ? second : second - slash - 1);
    cell.count = std::strtoull(number.c_str(), nullptr, 10);
  }
  if (second != std::string::npos) cell.variant = text.substr(second + 1);
  if (cell.count == 0 || (!cell.variant.empty() && cell.variant != "drift" && cell.variant != "one-percent"))
    throw Error("no cell is named A/" + text + "\n" + usage);
  return cell;
}

void run_boxes(const Choice& choice, const BoxCell& cell, Output& output) {
  MovingBoxes field(cell.field, cell.count);
  Turns<MovingBoxes, BoxContestant> turns;
  turns.add("Supple", 1, make_supple_boxes(1), field);
  if (!choice.only_supple) {
    for (const auto& entry : other_box_contestants()) {
      if (cell.count <= entry.largest) turns.add(entry.name, 1, entry.make(), field);
    }
  }
  turns.run(
      choice, field, [&] { field.advance(); }, same_pairs(choice.cell));
  output.records(turns.records());
}

/// One that has run for 500 frames against one that starts anew there.
void run_drift(const Choice& choice, const BoxCell& cell, Output& output) {
  constexpr int frames = 500;
  MovingBoxes field(cell.field, cell.count);
  Turns<MovingBoxes, BoxContestant> turns;
  auto drifted = make_supple_boxes(1);
  drifted->prepare(field);
  for (int frame = 0; frame < frames; ++frame) {
    field.advance();
    drifted->frame(field);
  }
  turns.add("Supple, drifted", 1, std::move(drifted), field);
  turns.add("Supple, fresh", 1, make_supple_boxes(1), field);
  turns.run(
      choice, field, [&] { field.advance(); }, same_pairs(choice.cell));
  output.records(turns.records());
}

/// A frame in which one box of a hundred moves against one in which all do. Two fields: each contestant has
/// its own.
class OnField : public BoxContestant {
 public:
  OnField(std::unique_ptr<BoxContestant> contestant, const MovingBoxes& field)
      : contestant_(std::move(contestant)), field_(field) {}
  void prepare(const MovingBoxes&) override { contestant_->prepare(field_); }
  void frame(const MovingBoxes&) override { contestant_->frame(field_); }
  PairDigest pairs() const override { return contestant_->pairs(); }

 private:
  std::unique_ptr<BoxContestant> contestant_;
  const MovingBoxes& field_;
};

void run_one_percent(const Choice& choice, const BoxCell& cell, Output& output) {
  MovingBoxes all(cell.field, cell.count), few(cell.field, cell.count);
  Turns<MovingBoxes, BoxContestant> turns;
  turns.add("Supple, all move", 1, std::make_unique<OnField>(make_supple_boxes(1), all), all);
  turns.add("Supple, one percent moves", 1, std::make_unique<OnField>(make_supple_boxes(1), few), all);
  turns.run(
      choice, all,
      [&] {
        all.advance();
        few.advance(100);
      },
      [](const auto&, const auto&, const auto&) {});
  output.records(turns.records());
}

// --- workload B ---

void run_copies(const Choice& choice, const std::string& name, bool two_threads, Output& output) {
  auto copies = make_deforming_copies(name);
  if (!copies) return output.skip("the bunny is not there; set SUPPLE_DATA");
  Turns<DeformingCopies, CopiesContestant> turns;
  turns.add("Supple", 1, make_supple_copies(1), *copies);
  if (two_threads) turns.add("Supple, 2 threads", 2, make_supple_copies(2), *copies);
  if (!two_threads && !choice.only_supple) {
    for (const auto& entry : other_copies_contestants()) {
      if (copies->triangle_count() <= entry.largest) turns.add(entry.name, 1, entry.make(), *copies);
    }
  }
  turns.run(
      choice, *copies, [&] { copies->advance(); }, same_pairs(choice.cell));
  output.value("triangles", static_cast<double>(copies->triangle_count()));
  output.records(turns.records());
}

// --- workload C ---

/// What exact verdicts, one by one, leave of the candidates.
PairDigest touching(const ClothStep& step, std::span<const ElementPair> candidates) {
  const auto edges = edges_of(step.triangles);
  PairDigest digest;
  const auto corners = [&](const std::vector<Vec3d>& p, std::array<std::uint32_t, 4> v) {
    return std::array<Vec3d, 4>{p[v[0]], p[v[1]], p[v[2]], p[v[3]]};
  };
  for (const ElementPair& pair : candidates) {
    if (pair.is_edge_edge) {
      const std::array<std::uint32_t, 4> v{edges[pair.a][0], edges[pair.a][1], edges[pair.b][0],
                                           edges[pair.b][1]};
      if (first_impact(EdgeEdgeMotion{corners(step.start, v), corners(step.end, v)}))
        digest.add(pair.a, pair.b);
    } else {
      const Triangle& t = step.triangles[pair.b];
      const std::array<std::uint32_t, 4> v{pair.a, t[0], t[1], t[2]};
      if (first_impact(VertexFaceMotion{corners(step.start, v), corners(step.end, v)}))
        digest.add(pair.a, pair.b + (std::uint64_t{1} << 32));
    }
  }
  return digest;
}

struct KnownCounts {
  const char* cloth;
  std::size_t vertex_face, edge_edge;
};
/// Of the real frames: pairs whose boxes overlap.
constexpr KnownCounts known_candidates[] = {{"cloth-funnel", 7319, 33770}, {"cloth-ball", 1655541, 5197332}};

void check_known(const Choice& choice, const std::string& cloth, std::span<const ElementPair> candidates) {
  const auto edge_edge = static_cast<std::size_t>(std::count_if(
      candidates.begin(), candidates.end(), [](const ElementPair& pair) { return pair.is_edge_edge; }));
  for (const KnownCounts& known : known_candidates) {
    if (known.cloth == cloth &&
        (known.edge_edge != edge_edge || known.vertex_face != candidates.size() - edge_edge))
      throw Disagreement(choice.cell + ": the others find " + std::to_string(candidates.size() - edge_edge) +
                         " / " + std::to_string(edge_edge) + " candidates, known are " +
                         std::to_string(known.vertex_face) + " / " + std::to_string(known.edge_edge));
  }
}

/// The same step there and back: every frame has new coordinates, and the same pairs.
void turn_round(ClothStep& step) {
  step.start.swap(step.end);
}

/// Candidates only.
class CandidatesOf : public Contestant<ClothStep> {
 public:
  explicit CandidatesOf(std::unique_ptr<ClothContestant> contestant) : contestant_(std::move(contestant)) {}
  void prepare(const ClothStep& step) override { contestant_->prepare(step); }
  void frame(const ClothStep& step) override { contestant_->frame(step); }
  PairDigest pairs() const override { return contestant_->pairs(); }

 private:
  std::unique_ptr<ClothContestant> contestant_;
};

void run_cloth(const Choice& choice, const std::string& name, bool two_threads, Output& output) {
  auto step = make_cloth_step(name);
  if (!step) return output.skip("the frames of " + name + " are not there; set SUPPLE_DATA");
  output.value("triangles", static_cast<double>(step->triangles.size()));
  std::optional<PairDigest> expected;
  const auto others = other_cloth_contestants();
  if (!others.empty() && !two_threads && !choice.only_supple) {
    const auto first = others.front().make();
    first->prepare(*step);
    first->frame(*step);
    check_known(choice, name, first->candidates());
    expected = touching(*step, first->candidates());
  }
  Turns<ClothStep, Contestant<ClothStep>> turns;
  turns.add("Supple", 1, make_supple_cloth(1), *step);
  if (two_threads) turns.add("Supple, 2 threads", 2, make_supple_cloth(2), *step);
  if (!two_threads && !choice.only_supple) {
    for (const auto& entry : others)
      turns.add(entry.name, 1, std::make_unique<CandidatesOf>(entry.make()), *step);
  }
  turns.run(
      choice, *step, [&] { turn_round(*step); },
      [&](const std::vector<std::size_t>& ran, const auto&, const std::vector<Record>& records) {
        if (expected && records[0].pairs != *expected)
          throw Disagreement(choice.cell + ": Supple finds " + text_of(records[0].pairs) +
                             " that touch, exact verdicts on all candidates " + text_of(*expected));
        // Contacts are compared with contacts, candidates with candidates.
        const std::size_t first = two_threads || records.size() < 2 ? 0 : 1;
        for (const std::size_t i : ran) {
          if (i >= first) check_equal(choice.cell, records[first], records[i]);
        }
      });
  output.records(turns.records());
}

// --- limits and memory ---

void run_bandwidth(Output& output) {
  for (const unsigned threads : {1u, 2u}) {
    pin_to(0, static_cast<int>(threads));
    const struct {
      const char* name;
      std::size_t kilobytes;
    } sizes[] = {{"L2", 512}, {"L3", 8192}, {"memory", 262144}};
    for (const auto& [name, kilobytes] : sizes) {
      output.value(std::string(name) + " GB/s, " + std::to_string(threads) + " threads",
                   read_bandwidth(threads * kilobytes * 1024, threads));
    }
  }
}

/// Supple's own refit: a scene of one object, which takes part in nothing else.
class SuppleRefit : public Contestant<DeformingCopies> {
 public:
  SuppleRefit() : contestant_(make_supple_copies(1)) {}
  void prepare(const DeformingCopies& copies) override { contestant_->prepare(copies); }
  void frame(const DeformingCopies& copies) override { contestant_->frame(copies); }
  PairDigest pairs() const override { return {}; }
  std::vector<StageTime> stages() const override { return contestant_->stages(); }

 private:
  std::unique_ptr<CopiesContestant> contestant_;
};

class Ideal : public Contestant<DeformingCopies> {
 public:
  explicit Ideal(std::size_t per_slot) : per_slot_(per_slot) {}
  void prepare(const DeformingCopies& copies) override {
    refit_ = std::make_unique<IdealRefit>(copies.mesh(), per_slot_);
  }
  void frame(const DeformingCopies&) override { refit_->run(); }
  PairDigest pairs() const override { return {}; }

 private:
  std::size_t per_slot_;
  std::unique_ptr<IdealRefit> refit_;
};

void run_refit(const Choice& choice, const std::string& triangles, Output& output) {
  auto mesh = make_deforming_copies(triangles + "x1");
  if (!mesh) return output.skip("the bunny is not there; set SUPPLE_DATA");
  Turns<DeformingCopies, CopiesContestant> turns;
  turns.add("Supple", 1, std::make_unique<SuppleRefit>(), *mesh);
  turns.add("ideal, 1 per slot", 1, std::make_unique<Ideal>(1), *mesh);
  turns.add("ideal, 4 per slot", 1, std::make_unique<Ideal>(4), *mesh);
  turns.run(
      choice, *mesh, [&] { mesh->advance(); }, [](const auto&, const auto&, const auto&) {});
  output.value("triangles", static_cast<double>(mesh->triangle_count()));
  output.records(turns.records());
}

double heap_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

/// All that a scene of two copies holds on the heap after some steps, and of it the octrees.
void run_memory(const std::string& shape, Output& output) {
  auto copies = make_deforming_copies(shape + "x2");
  if (!copies) return output.skip("the bunny is not there; set SUPPLE_DATA");
  const double before = heap_bytes();
  SceneOptions options;
  options.threads = 1;
  Scene scene(options);
  std::vector<ObjectId> objects;
  for (std::size_t i = 0; i < copies->copies(); ++i)
    objects.push_back(scene.add(PositionsView<float>(copies->positions(i)), copies->triangles()));
  for (int frame = 0; frame < 3; ++frame) {
    copies->advance();
    for (std::size_t i = 0; i < objects.size(); ++i) scene.set_positions(objects[i], copies->positions(i));
    scene.detect();
  }
  malloc_trim(0);
  const double held = heap_bytes() - before;
  double octrees = 0, positions = 0;
  for (const ObjectId object : objects) {
    octrees += static_cast<double>(scene.octree_statistics(object).bytes);
    positions += static_cast<double>(scene.vertex_count(object) * sizeof(Vec3f));
  }
  const auto triangles = static_cast<double>(copies->triangle_count());
  output.value("triangles", triangles);
  output.value("heap bytes a triangle", held / triangles);
  output.value("octree bytes a triangle", octrees / triangles);
  output.value("positions bytes a triangle", positions / triangles);
}

// --- cells ---

void run(const Choice& choice) {
  const std::string& cell = choice.cell;
  Output output(cell);
  const auto after = [&](std::string_view prefix) { return cell.substr(prefix.size()); };
  const bool two_threads = cell.starts_with("threads/");
  if (two_threads)
    pin_to(0, 2);
  else if (!cell.starts_with("limits/bandwidth"))
    pin_to(choice.cpu, 1);
  if (cell.starts_with("A/")) {
    const BoxCell boxes = box_cell_of(after("A/"));
    if (boxes.variant == "drift")
      run_drift(choice, boxes, output);
    else if (boxes.variant == "one-percent")
      run_one_percent(choice, boxes, output);
    else
      run_boxes(choice, boxes, output);
  } else if (cell.starts_with("B/")) {
    run_copies(choice, after("B/"), false, output);
  } else if (cell.starts_with("growth/")) {
    Choice alone = choice;
    alone.only_supple = true;
    run_copies(alone, after("growth/"), false, output);
  } else if (cell.starts_with("C/")) {
    run_cloth(choice, after("C/"), false, output);
  } else if (cell.starts_with("threads/B/")) {
    run_copies(choice, after("threads/B/"), true, output);
  } else if (cell.starts_with("threads/C/")) {
    run_cloth(choice, after("threads/C/"), true, output);
  } else if (cell == "limits/bandwidth") {
    run_bandwidth(output);
  } else if (cell.starts_with("limits/refit/")) {
    run_refit(choice, after("limits/refit/"), output);
  } else if (cell.starts_with("memory/")) {
    run_memory(after("memory/"), output);
  } else {
    throw Error("no cell is named '" + cell + "'\n" + usage);
  }
  output.print();
}

double number_of(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(number >= 0)) throw Error("'" + text + "' is no number\n" + usage);
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

/// 0; 1 for wrong use; 3 when contestants disagree.
int main(int argument_count, char** arguments) {
  using namespace supple::benchmarks;
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
