"""Plots under the view: curves of a run over its whole time, and a mark at the time shown."""

import html
from collections.abc import Sequence

import numpy as np

from uvms_bringup.viewer.overview import Plot
from uvms_core.signals import Array

COLOURS = ("#0a6ebd", "#e8590c", "#0b7d5b", "#c2185b", "#6741d9", "#8a6d00", "#5c636a", "#d6336c")
HEIGHT_PX, TAB_PX = 180, 20
NARROWEST_PX = 220
"""Of a plot; where the window is too narrow for all, they are scrolled."""
WIDE, HIGH = 400, 100
"""Of a plot, in the units of its own lines."""
MIDDLE, FLAT = 1.0, 4.0
"""Where all values span more than `FLAT` times what those between these percentiles do, the
others are cut off and told in words: the first instant of a run may have a hundred times the
disturbance of all that follow."""
STYLE = f"""
#root {{ height: calc(100% - {HEIGHT_PX}px) !important; }}
#plots {{ position: relative; height: {HEIGHT_PX}px; width: 100%; box-sizing: border-box;
  border-top: 1px solid #cfd6dc; background: #fff; font: 11px system-ui, sans-serif;
  color: #19283a; }}
#plots .all {{ height: 100%; box-sizing: border-box; padding: 6px 10px; display: flex; gap: 14px;
  overflow-x: auto; overflow-y: hidden; }}
#plots figure {{ flex: 1 0 {NARROWEST_PX}px; min-width: 0; margin: 0; display: flex;
  flex-direction: column; }}
#plots figcaption {{ white-space: nowrap; overflow: hidden; text-overflow: ellipsis; }}
#plots .field {{ position: relative; flex: 1 1 0; min-height: 0; border: 1px solid #cfd6dc;
  overflow: hidden; }}
#plots svg {{ position: absolute; width: 100%; height: 100%; will-change: transform; }}
#plots polyline {{ fill: none; stroke-width: 1.3; vector-effect: non-scaling-stroke; }}
#plots .now {{ position: absolute; top: 0; bottom: 0; left: 0; width: 100%; will-change: transform;
  border-left: 1px solid #c2185b; background: rgba(255, 255, 255, 0.6); }}
#plots .ends {{ display: flex; justify-content: space-between; color: #5c6b7a; }}
#plots .names {{ height: 33px; font-size: 10px; line-height: 11px; overflow: hidden; }}
#plots .names span {{ margin-right: 0.7em; white-space: nowrap; }}
#plots button {{ position: absolute; right: 10px; top: {-TAB_PX}px; height: {TAB_PX}px;
  padding: 0 8px; border: 1px solid #cfd6dc; border-bottom: 0; background: #fff; color: #0a6ebd;
  font: inherit; cursor: pointer; z-index: 20; }}
.folded #root {{ height: 100% !important; }}
.folded #plots {{ height: 0; }}
.folded #plots .all {{ display: none; }}
"""
SCRIPT = """
(() => {
  const marks = document.querySelectorAll('#plots .now');
  const fold = document.querySelector('#plots button');
  const label = () => {
    const isFolded = document.body.classList.contains('folded');
    fold.textContent = isFolded ? 'show plots' : 'hide plots';
  };
  fold.onclick = () => { document.body.classList.toggle('folded'); label(); };
  label();
  let shown = '';
  setInterval(() => {
    const bar = document.querySelector('#root [role=slider][aria-valuemax]');
    if (!bar) return;
    const [low, now, high] = [bar.ariaValueMin, bar.ariaValueNow, bar.ariaValueMax].map(Number);
    const place = `translateX(${(100 * (now - low) / (high - low)).toFixed(2)}%)`;
    if (place === shown) return;
    shown = place;
    for (const mark of marks) mark.style.transform = place;
  }, 100);
})();
"""
"""The time line of the page is the clock."""


def plot_strip(times: Array, plots: Sequence[Plot]) -> tuple[str, str]:
    """What a page needs in its head, and at the end of its body.

    Args:
        times: (k,) s.
        plots: over these times; those of which nothing is known are left out.
    """
    known = [plot for plot in plots if np.isfinite(plot.values).any()]
    if not known:
        return "", ""
    figures = "".join(_figure(times, plot) for plot in known)
    body = f'<div id="plots"><button></button><div class="all">{figures}</div></div>'
    return f"<style>{STYLE}</style>", f"{body}<script>{SCRIPT}</script>"


def _figure(times: Array, plot: Plot) -> str:
    known = np.flatnonzero(np.isfinite(plot.values).any(axis=0))
    low, high = _range(plot.values)
    least, most = float(np.nanmin(plot.values)), float(np.nanmax(plot.values))
    lines, names = "", []
    for row in known:
        colour = COLOURS[row % len(COLOURS)]
        points = _points(times, plot.values[:, row], low, high)
        lines += f'<polyline stroke="{colour}" points="{points}"/>'
        names.append(f'<span style="color:{colour}">{html.escape(plot.names[row])}</span>')
    view = f'viewBox="0 0 {WIDE} {HIGH}" preserveAspectRatio="none"'
    title, beyond = html.escape(plot.title), ""
    if (least, most) != (low, high):
        beyond = f"; beyond it {least if least < low else most:.3g}"
    return (
        f"<figure><figcaption><b>{title}</b>, {low:.3g} to {high:.3g} {plot.unit}{beyond}"
        "</figcaption>"
        f'<div class="field"><svg {view}>{lines}</svg><div class="now"></div></div>'
        f'<div class="ends"><span>{times[0]:.4g} s</span><span>{times[-1]:.4g} s</span></div>'
        f'<div class="names">{" ".join(names)}</div></figure>'
    )


def _range(values: Array) -> tuple[float, float]:
    """What a plot shows: all, unless a few values would press the others flat."""
    least, most = float(np.nanmin(values)), float(np.nanmax(values))
    low, high = (float(part) for part in np.nanpercentile(values, (MIDDLE, 100.0 - MIDDLE)))
    room = high - low
    if most - least <= FLAT * room or room == 0.0:
        return least, most
    return max(least, low - room), min(most, high + room)


def _points(times: Array, values: Array, low: float, high: float) -> str:
    """A curve in the units of the plot, from the top left; what is not known is left out."""
    known = np.isfinite(values)
    x = WIDE * (times - times[0]) / (times[-1] - times[0])
    y = HIGH * (high - np.clip(values, low, high)) / ((high - low) or 1.0)
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x[known], y[known], strict=True))
