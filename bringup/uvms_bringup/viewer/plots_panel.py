"""Curves under the scene that grow with the time."""

import numpy as np
import viser
import viser.uplot as uplot

from uvms_bringup.viewer.overview import Plot
from uvms_core.signals import Array

COLOURS = ("#0a6ebd", "#e8590c", "#0b7d5b", "#c2185b", "#6741d9", "#8a6d00", "#5c636a", "#d6336c")
HEIGHT, WIDTH, EDGE = 170, 640, 15
"""Of the panel in pixels."""


class PlotsPanel:
    """One tab for each plot; what lies after the time shown is left out.

    Args:
        gui: of the page.
        times: (k,) s.
        plots: over these times.
    """

    def __init__(self, gui: viser.GuiApi, times: Array, plots: tuple[Plot, ...]) -> None:
        self._times, self._count = times, -1
        panel = gui.add_panel()
        panel.float(x=EDGE, y=-EDGE, width=WIDTH)
        self._curves = []
        for plot in plots:
            known = np.atleast_1d(np.isfinite(plot.values).any(axis=0))
            if not known.any():
                continue
            names = [name for name, is_known in zip(plot.names, known, strict=True) if is_known]
            values = plot.values[:, known]
            with panel.add_tab(plot.title):
                self._curves.append((_chart(gui, times, names, values, plot.unit), values))

    def show(self, time: float) -> None:
        """Draw the curves up to a time, s."""
        count = max(int(np.searchsorted(self._times, time, side="right")), 2)
        if count == self._count:
            return
        self._count = count
        for chart, values in self._curves:
            chart.data = (self._times[:count], *values[:count].T)


def _chart(
    gui: viser.GuiApi, times: Array, names: list[str], values: Array, unit: str
) -> viser.GuiUplotHandle:
    lines = [
        uplot.Series(label=f"{name} [{unit}]", stroke=COLOURS[n % len(COLOURS)], width=1.5)
        for n, name in enumerate(names)
    ]
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    room = 0.05 * (high - low) or 1.0
    return gui.add_uplot(
        (times, *values.T),
        (uplot.Series(label="time [s]"), *lines),
        scales={
            "x": uplot.Scale(time=False, range=(float(times[0]), float(times[-1]))),
            "y": uplot.Scale(range=(low - room, high + room)),
        },
        height=HEIGHT,
    )
