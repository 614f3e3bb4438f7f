#include <algorithm>
#include <cstdlib>

#include "contest/cells/cells.hpp"

namespace supple::benchmarks {
namespace {

struct BoxCell {
  std::string field, variant;
  std::size_t count = 0, one_in = 0;  // every `one_in`-th box moves; 0: all of them
};

BoxCell box_cell_of(const std::string& text) {  // `text` is the name without "A/"
  BoxCell cell;
  const std::size_t slash = text.find('/'), second = text.find('/', slash + 1);
  cell.field = text.substr(0, slash);
  if (slash != std::string::npos) {
    const std::string number =
        text.substr(slash + 1, second == std::string::npos ? second : second - slash - 1);
    cell.count = std::strtoull(number.c_str(), nullptr, 10);
  }
  if (second != std::string::npos) cell.variant = text.substr(second + 1);
  if (cell.variant == "one-percent") cell.one_in = 100;
  if (cell.variant.starts_with("one-in-")) cell.one_in = std::strtoull(cell.variant.c_str() + 7, nullptr, 10);
  if (cell.count == 0 || (!cell.variant.empty() && cell.variant != "drift" && cell.one_in == 0))
    throw Error("no cell is named A/" + text +
                "; write FIELD/N, FIELD/N/drift, FIELD/N/one-percent or FIELD/N/one-in-K");
  return cell;
}

void run_all(const Choice& choice, const BoxCell& cell, Output& output) {
  MovingBoxes field(cell.field, cell.count);
  Turns<MovingBoxes, BoxContestant> turns;
  turns.add("Supple", 1, make_supple_boxes(1), field);
  turns.add("Supple octree", 1, make_supple_boxes(1, BroadPhaseMethod::octree), field);
  if (!choice.only_supple) {
    for (const auto& entry : other_box_contestants()) {
      if (cell.count <= entry.largest) turns.add(entry.name, 1, entry.make(), field);
    }
  }
  turns.run(
      choice, field, [&] { field.advance(); }, same_pairs(choice.cell));
  output.records(turns.records());
}

/// Compares an instance that has run for 500 frames with a new instance.
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

/// Runs a contestant on its own field. The cell compares frames in which every `one_in`-th box moves, with
/// and without a dirty list, with frames in which all boxes move.
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

void run_few(const Choice& choice, const BoxCell& cell, Output& output) {
  MovingBoxes all(cell.field, cell.count), few(cell.field, cell.count);
  std::vector<std::uint32_t> moving;
  for (std::size_t i = 0; i < cell.count; i += cell.one_in) moving.push_back(static_cast<std::uint32_t>(i));
  const std::string share = cell.one_in == 100 ? "one percent" : "one in " + std::to_string(cell.one_in);
  Turns<MovingBoxes, BoxContestant> turns;
  turns.add("Supple, all move", 1, std::make_unique<OnField>(make_supple_boxes(1), all), all);
  turns.add("Supple, " + share + " moves", 1, std::make_unique<OnField>(make_supple_boxes(1), few), all);
  turns.add("Supple, " + share + " moves, dirty list", 1,
            std::make_unique<OnField>(make_supple_boxes_with_dirty_list(moving), few), all);
  turns.run(
      choice, all,
      [&] {
        all.advance();
        few.advance(cell.one_in);
      },
      [&](const std::vector<std::size_t>& ran, const auto&, const std::vector<Record>& records) {
        const auto did = [&](std::size_t i) { return std::find(ran.begin(), ran.end(), i) != ran.end(); };
        if (did(1) && did(2)) check_equal(choice.cell, records[1], records[2]);
      });
  output.records(turns.records());
}

}  // namespace

void run_boxes(const Choice& choice, const std::string& name, Output& output) {
  const BoxCell cell = box_cell_of(name);
  if (cell.variant == "drift")
    run_drift(choice, cell, output);
  else if (cell.one_in != 0)
    run_few(choice, cell, output);
  else
    run_all(choice, cell, output);
}

}  // namespace supple::benchmarks
