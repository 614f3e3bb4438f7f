"""Numbers as texts."""

import math


def rounded(value, digits=3):
    """With significant digits and grouped thousands; only numbers far from 1 in scientific notation."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞" if value > 0 else "-∞"
    if value == 0:
        return "0"
    scientific = f"{value:.{digits - 1}e}"
    magnitude = int(scientific[scientific.index("e") + 1 :])
    if magnitude < -5 or magnitude > 8:
        return scientific
    return f"{round(value, digits - 1 - magnitude):,.{max(0, digits - 1 - magnitude)}f}"
