"""Figures with matplotlib, which the extra ``reachtube[plot]`` installs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import whole
from ._reach import ReachableSet
from ._recordings import Recordings, Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["flowpipe", "reachable_set"]


def reachable_set(
    found: ReachableSet,
    data: Recordings | Sequence[Run] = (),
    *,
    deviation: bool = False,
    figure: Figure | None = None,
) -> Figure:
    """Draw a reachable set over time, one panel for each state, with recordings of its suite.

    Parameters
    ----------
    found
        What `reach` returned.
    data
        Recordings. Other suites, and other runs if the set belongs to one run, are left out.
    deviation
        Whether the nominal motion is subtracted.
    figure
        The figure to draw in; a new one if none is given.

    Returns
    -------
    Figure
    """
    import matplotlib.pyplot as plt

    n = found.joints
    drawing = figure or plt.figure(figsize=(2.6 * n, 4.4), layout="constrained")
    axes: Any = drawing.subplots(2, n, sharex=True, squeeze=False)
    base = found.nominal if deviation else np.zeros_like(found.nominal)
    runs = [
        run
        for run in data
        if run.suite == found.suite and found.run in (None, run.name)
    ]
    for i in range(2 * n):
        axis = axes[i // n, i % n]
        low, high = found.lower[:, i] - base[:, i], found.upper[:, i] - base[:, i]
        axis.fill_between(found.t, low, high, color="0.82", linewidth=0, label="reachable set")
        for run in runs:
            count = min(len(run), len(found.t))
            values = (run.q if i < n else run.qd)[:count, i % n] - base[:count, i]
            axis.plot(found.t[:count], values, color="tab:blue", alpha=0.6, linewidth=0.8)
        axis.set_title(f"joint {i % n + 1}" if i < n else "")
        axis.margins(x=0)
        # A label holds for the panels to its right, up to the next one.
        if i % n == 0 or found.units[i] != found.units[i - 1]:
            axis.set_ylabel(f"{'q' if i < n else 'qd'} [{found.units[i]}]")
    drawing.supxlabel("t [s]")
    return drawing


def flowpipe(
    lower: Any, upper: Any, x: int = 0, y: int = 1, *, axis: Axes | None = None
) -> Axes:
    """Draw boxes of a flowpipe in the plane of two states.

    Parameters
    ----------
    lower : array of shape (K, N)
        Lower bounds, such as ``step_lower`` of a `Flowpipe`.
    upper : array of shape (K, N)
        Upper bounds.
    x
        The state along the horizontal axis, from 0.
    y
        The state along the vertical axis, from 0.
    axis
        The axes to draw in; new ones if none are given.

    Returns
    -------
    Axes
    """
    count = np.shape(lower)[-1]
    x, y = whole("x", x, 0, count - 1), whole("y", y, 0, count - 1)
    import matplotlib.pyplot as plt
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Rectangle

    drawing = axis or plt.figure(layout="constrained").add_subplot()
    boxes = [
        Rectangle((low[x], low[y]), high[x] - low[x], high[y] - low[y])
        for low, high in zip(lower, upper, strict=True)
    ]
    drawing.add_collection(PatchCollection(boxes, facecolor="tab:blue", alpha=0.35))
    drawing.autoscale_view()
    return drawing
