#include "golden_hashes.hpp"

#include <cinttypes>
#include <cstdio>

#include "support/golden_models.hpp"
#include "support/golden_motion.hpp"
#include "support/golden_scenes.hpp"

Results compute_golden_hashes() {
  Results results{supple::empty_hash, supple::empty_hash};
  const auto compute = [&](const auto& hashes) {
    for (const supple::GoldenHash& golden : hashes) {
      const std::uint64_t hash = golden.compute(1);
      if (hash != golden.value)
        std::fprintf(stderr, "%s: %" PRIu64 " instead of %" PRIu64 "\n", golden.part, hash, golden.value);
      results = {supple::hash_of_word(hash, results.hash),
                 supple::hash_of_word(golden.value, results.expected)};
    }
  };
  compute(supple::golden_scene_hashes);
  compute(supple::golden_model_hashes);
  compute(supple::golden_motion_hashes);
  return results;
}
