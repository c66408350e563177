"""Plots under the view of the shared file: curves of the run, and a mark at the time shown."""

import html
from collections.abc import Sequence

import numpy as np

from uvms_bringup.viewer.overview import Plot
from uvms_bringup.viewer.plots_panel import COLOURS
from uvms_core.signals import Array

HEIGHT_PX = 170
WIDE, HIGH = 400, 100
"""Of a plot, in the units of its own lines."""
STYLE = f"""
#root {{ height: calc(100% - {HEIGHT_PX}px) !important; }}
#plots {{ height: {HEIGHT_PX}px; width: 100%; box-sizing: border-box; padding: 6px; display: flex;
  gap: 12px; background: #fff; font: 11px system-ui, sans-serif; color: #19283a; }}
#plots figure {{ flex: 1 1 0; min-width: 0; margin: 0; display: flex; flex-direction: column; }}
#plots .field {{ position: relative; flex: 1 1 0; min-height: 0; border: 1px solid #cfd6dc; }}
#plots svg {{ position: absolute; width: 100%; height: 100%; }}
#plots polyline {{ fill: none; stroke-width: 1.3; vector-effect: non-scaling-stroke; }}
#plots .now {{ position: absolute; top: 0; bottom: 0; width: 1px; background: #c2185b; }}
#plots .ends {{ display: flex; justify-content: space-between; }}
#plots .names {{ height: 2.6em; overflow: hidden; }}
"""
SCRIPT = """
(() => {
  const marks = document.querySelectorAll('#plots .now');
  const follow = () => {
    const bar = document.querySelector('#root [role=slider][aria-valuemax]');
    if (bar) {
      const share = Number(bar.ariaValueNow) / Number(bar.ariaValueMax);
      for (const mark of marks) mark.style.left = (100 * share) + '%';
    }
    requestAnimationFrame(follow);
  };
  follow();
})();
"""
"""viser's time line is the clock; its steps are those of the recorded frames."""


def with_plots(page: str, times: Array, plots: Sequence[Plot]) -> str:
    """A page that viser made, with plots under its view.

    Args:
        page: HTML of a recorded scene that plays from the first to the last of the times.
        times: (k,) s.
        plots: over these times; those of which nothing is known are left out.
    """
    figures = "".join(_figure(times, plot) for plot in plots if np.isfinite(plot.values).any())
    head, body = page.index("</head>"), page.rindex("</body>")
    return (
        f"{page[:head]}<style>{STYLE}</style>{page[head:body]}"
        f'<div id="plots">{figures}</div><script>{SCRIPT}</script>{page[body:]}'
    )


def _figure(times: Array, plot: Plot) -> str:
    known = np.flatnonzero(np.isfinite(plot.values).any(axis=0))
    low, high = float(np.nanmin(plot.values)), float(np.nanmax(plot.values))
    lines, names = "", []
    for row in known:
        colour = COLOURS[row % len(COLOURS)]
        points = _points(times, plot.values[:, row], low, high)
        lines += f'<polyline stroke="{colour}" points="{points}"/>'
        names.append(f'<span style="color:{colour}">{html.escape(plot.names[row])}</span>')
    view = f'viewBox="0 0 {WIDE} {HIGH}" preserveAspectRatio="none"'
    return (
        f"<figure><b>{html.escape(plot.title)}, {low:.3g} to {high:.3g} {plot.unit}</b>"
        f'<div class="field"><svg {view}>{lines}</svg><div class="now"></div></div>'
        f'<div class="ends"><span>{times[0]:.4g} s</span><span>{times[-1]:.4g} s</span></div>'
        f'<div class="names">{" ".join(names)}</div></figure>'
    )


def _points(times: Array, values: Array, low: float, high: float) -> str:
    """A curve in the units of the plot, from the top left; what is not known is left out."""
    known = np.isfinite(values)
    x = WIDE * (times - times[0]) / (times[-1] - times[0])
    y = HIGH * (high - values) / ((high - low) or 1.0)
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x[known], y[known], strict=True))
