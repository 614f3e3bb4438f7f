#include <cstdlib>

#include "contest/cells.hpp"

namespace supple::benchmarks {
namespace {

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
    throw Error("no cell is named A/" + text + "; write FIELD/N, FIELD/N/drift or FIELD/N/one-percent");
  return cell;
}

void run_all(const Choice& choice, const BoxCell& cell, Output& output) {
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

}  // namespace

void run_boxes(const Choice& choice, const std::string& name, Output& output) {
  const BoxCell cell = box_cell_of(name);
  if (cell.variant == "drift")
    run_drift(choice, cell, output);
  else if (cell.variant == "one-percent")
    run_one_percent(choice, cell, output);
  else
    run_all(choice, cell, output);
}

}  // namespace supple::benchmarks
