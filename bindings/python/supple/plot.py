"""Plots of frames: counts of contacts and times of the stages. Needs matplotlib."""

from __future__ import annotations

from typing import Any, Iterable

from ._result import _LISTS, ANSWERS, _Lists

_STAGES = (
    "refit_seconds",
    "broad_phase_seconds",
    "rebuild_seconds",
    "traversal_seconds",
    "exact_seconds",
    "penetration_seconds",
    "manifold_seconds",
    "sort_and_events_seconds",
)


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    from matplotlib import pyplot

    return pyplot.subplots(figsize=(7, 3.2), layout="constrained")[1]


def counts(frames: Iterable[_Lists], axes: Any = None) -> Any:
    """The number of contacts of each kind by frame: of results, or of the frames of a recording. Returns the
    axes."""
    axes = _axes(axes)
    found = [each._counts() for each in frames]
    for name in ANSWERS:
        values = [each.get(name, 0) for each in found]
        if any(values):
            axes.plot(values, label=f"{_LISTS[name][0]}s")
    axes.set(xlabel="frame", ylabel="count", ylim=(0, None))
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    return axes


def times(frames: Iterable[Any], axes: Any = None) -> Any:
    """The milliseconds of each stage by frame, stacked. Returns the axes."""
    axes = _axes(axes)
    stats = [each.stats for each in frames]
    stages = [stage for stage in _STAGES if any(each[stage] for each in stats)]
    axes.stackplot(
        range(len(stats)),
        [[1e3 * each[stage] for each in stats] for stage in stages],
        labels=[stage.removesuffix("_seconds").replace("_", " ") for stage in stages],
    )
    axes.set(xlabel="frame", ylabel="time, ms", ylim=(0, None))
    if stages:
        axes.legend(loc="upper right")
    return axes


__all__ = ["counts", "times"]
