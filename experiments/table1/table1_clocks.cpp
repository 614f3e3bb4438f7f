#include "table1/table1_clocks.hpp"

#include <string>
#include <utility>

#include "table1/paper_table.hpp"

namespace supple::experiments {

Quantity number_of(Member member) {
  return [member](const RunCounts& run) { return static_cast<double>(run.*member); };
}

std::vector<Both> with_both(const std::vector<Runs>& all) {
  std::vector<Both> result;
  for (const Runs& runs : all) {
    if (runs.volume != BoundingVolume::aabb || !runs.is_first_size) continue;
    if (const Runs* const spheres = find(all, runs.scene.name, BoundingVolume::sphere))
      result.push_back({&runs, spheres});
  }
  return result;
}

Estimate sphere_ratio(const std::vector<Both>& scenes, const Quantity& quantity) {
  std::vector<double> of_boxes, of_spheres;
  for (const auto& [boxes, spheres] : scenes) {
    for (std::size_t i = 0; i < boxes->counts.size(); ++i) {
      if (!boxes->counts[i].failure.empty() || !spheres->counts[i].failure.empty()) continue;
      of_boxes.push_back(quantity(boxes->counts[i]));
      of_spheres.push_back(quantity(spheres->counts[i]));
    }
  }
  return ratio_of_sums(of_spheres, of_boxes);
}
Estimate sphere_ratio(const std::vector<Both>& scenes, Member member) {
  return sphere_ratio(scenes, number_of(member));
}

std::array<ByClock, 3> by_clocks(const std::vector<Runs>& steps, const std::vector<Runs>& program) {
  const std::vector<Runs>* const first = steps.empty() ? &program : &steps;
  return {{{"simulated", "Simulated time", &steps, number_of},
           {"detection", "Detection alone", first,
            [](Member member) {
              return Quantity(
                  [member](const RunCounts& run) { return in_ten_minutes_of_detection(run.*member, run); });
            }},
           {"program", "Whole program", program.empty() ? first : &program, [](Member member) {
              return Quantity(
                  [member](const RunCounts& run) { return in_ten_minutes_of_program(run.*member, run); });
            }}}};
}

namespace {

void add_number(std::vector<Cell>& row, const Estimate& number) {
  row.push_back(cell_of(number.mean));
  row.push_back(cell_of(number.error));
}

/// The columns of all clocks and of the paper, each with an error.
void add_columns(Table& table, const std::array<ByClock, 3>& clocks) {
  const auto add = [&](const std::string& name, const char* heading) {
    table.columns.push_back({name, heading});
    table.columns.push_back({name + "_error", "± error", 2});
  };
  for (const ByClock& clock : clocks) add(clock.name, clock.heading);
  add("paper", "The paper");
}

constexpr std::pair<const char*, Member> columns_of_table1[] = {{"broad", &RunCounts::broad},
                                                                {"narrow", &RunCounts::narrow}};

}  // namespace

Table rates_table(const std::vector<Runs>& steps, const std::vector<Runs>& program) {
  const auto clocks = by_clocks(steps, program);
  Table table{"table1_rates",
              "Collisions in ten minutes by each clock, and in the paper",
              {{"scene", "Scene"}, {"edge", "Edge"}, {"volume", "Volume"}, {"phase", "Phase"}}};
  add_columns(table, clocks);
  for (const Runs& runs : steps.empty() ? program : steps) {
    for (const auto& [phase, member] : columns_of_table1) {
      std::vector<Cell> row{runs.scene.name, runs.edge ? Cell(*runs.edge) : Cell(),
                            std::string(word_of(runs.volume)), std::string(phase)};
      for (const ByClock& clock : clocks) {
        std::vector<double> numbers;
        for (const Runs& same : *clock.runs) {
          if (same.scene.name != runs.scene.name || same.edge != runs.edge || same.volume != runs.volume)
            continue;
          // Simulated time needs no clock, only the length of the run.
          const double factor =
              clock.runs == &steps && clock.quantity == number_of ? 600 / same.run_seconds : 1;
          for (const RunCounts& run : same.counts) {
            if (run.failure.empty()) numbers.push_back(factor * clock.quantity(member)(run));
          }
        }
        add_number(row, estimate_of(numbers));
      }
      const PaperRow* const paper = is_of_table(runs) ? paper_row(runs.scene.objects, runs.volume) : nullptr;
      add_number(row, paper == nullptr
                          ? estimate_of({})
                          : estimate_of(member == &RunCounts::broad ? paper->broad : paper->narrow));
      table.add(std::move(row));
    }
  }
  return table;
}

Table clocks_table(const std::vector<Runs>& steps, const std::vector<Runs>& program) {
  const auto clocks = by_clocks(steps, program);
  Table table{"table1_clocks",
              "Collisions with spheres for each collision with boxes, by each clock, and in the paper",
              {{"scene", "Scene"}, {"phase", "Phase"}}};
  add_columns(table, clocks);
  for (const Both& both_runs : with_both(steps.empty() ? program : steps)) {
    const std::string& scene = both_runs.boxes->scene.name;
    for (const auto& [phase, member] : columns_of_table1) {
      std::vector<Cell> row{scene, std::string(phase)};
      for (const ByClock& clock : clocks) {
        std::vector<Both> of_scene = with_both(*clock.runs);
        std::erase_if(of_scene, [&](const Both& other) { return other.boxes->scene.name != scene; });
        add_number(row, sphere_ratio(of_scene, clock.quantity(member)));
      }
      const auto of_paper = is_of_table(*both_runs.boxes)
                                ? paper_ratio(both_runs.boxes->objects, member == &RunCounts::broad)
                                : std::nullopt;
      add_number(row, of_paper.value_or(estimate_of({})));
      table.add(std::move(row));
    }
  }
  return table;
}

}  // namespace supple::experiments
