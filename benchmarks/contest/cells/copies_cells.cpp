#include "contest/cells/cells.hpp"

namespace supple::benchmarks {

void run_copies(const Choice& choice, const std::string& name, bool two_threads, Output& output) {
  auto copies = make_deforming_copies(name);
  if (!copies) return output.skip("the bunny is not there; set SUPPLE_DATA");
  Turns<DeformingCopies, CopiesContestant> turns;
  turns.add("Supple", 1, make_supple_copies(1), *copies);
  if (!two_threads) turns.add("Supple, pairs only", 1, make_supple_copies(1, CopyResults::pairs), *copies);
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

}  // namespace supple::benchmarks
