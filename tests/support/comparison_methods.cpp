#include "supple/comparison.hpp"

/// For programs whose `main` is not ours: their scenes may have all options.
[[maybe_unused]] static const bool uses_comparison_methods = (supple::use_comparison_methods(), true);
