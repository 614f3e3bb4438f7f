#include "supple/comparison.hpp"
#include "supple/use_manifolds.hpp"

/// For programs whose `main` is not ours: their scenes may have all options.
[[maybe_unused]] static const bool uses_all_methods =
    (supple::use_comparison_methods(), supple::use_manifolds(), true);
