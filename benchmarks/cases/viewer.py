"""The 3-D page of the whole manipulation: time to its start, frames, memory, shared file."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
from metrics import Metric, Target

from uvms_bringup.cli import main
from uvms_bringup.viewer.export import export
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.page import LogPage, Site

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "uvms_bringup"))
from browser import browser_tab
from viewed import served

SIZE = (1280, 720)
COUNT_S = 4
"""Wall time over which frames are counted."""
COUNT = f"""new Promise(done => {{
  let frames = 0; const began = performance.now();
  const next = () => {{
    frames += 1; const passed = performance.now() - began;
    passed < {1000 * COUNT_S} ? requestAnimationFrame(next) : done(1000 * frames / passed);
  }};
  requestAnimationFrame(next);
}})"""
"""Frames a second. While the run plays the page asks for one after the other."""
TURNS = 5
"""Of our scene and of an empty one; the medians count."""
LOOPS, LOOPS_FULL = 4, 20
STOPS = 60
"""Times of the run that are shown in each loop."""


def measure(full: bool) -> Iterator[Metric]:
    """In Chromium at 1280 x 720, which draws with the processor: a graphics card is faster.

    The memory is that of the page's objects after garbage collection, when the run has been gone
    through several times, over that after the first time.
    """
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        run = Path(folder) / "run"
        with redirect_stdout(sys.stderr):
            code = main(["simulate", "manipulation", "--output", str(run)])
        if code != 0:
            raise RuntimeError("the manipulation could not be simulated")
        with browser_tab(Path(folder) / "profile", SIZE) as tab:
            yield from _page(run, tab, LOOPS_FULL if full else LOOPS)
        began = time.perf_counter()
        file = export(LogSource(run), Path(folder) / "run.html")
        yield Metric("viewer_export", time.perf_counter() - began, "s")
        size = file.stat().st_size / 1e6
        yield Metric("viewer_export_size", size, "MB", target=Target("value", "<=", 20.0))


def _page(run: Path, tab: Any, loops: int) -> Iterator[Metric]:
    yield Metric("viewer_ready", _ready(run, tab), "s", target=Target("value", "<=", 5.0))
    page = LogPage(LogSource(run), Site(port=0))
    with served(page):
        tab.open(page.address)
        tab.wait_for_text("UVMS: manipulation")
        yield _frames(page, tab)
        yield _memory(page, tab, loops)


def _ready(run: Path, tab: Any) -> float:
    """From the command to the page in a browser that is open already."""
    command = [sys.executable, "-m", "uvms_bringup.cli", "view", str(run), "--no-browser"]
    began = time.perf_counter()
    with subprocess.Popen([*command, "--port", "0"], stdout=subprocess.PIPE, text=True) as view:
        assert view.stdout is not None
        tab.open(view.stdout.readline().split()[1])
        tab.wait_for_text("UVMS: manipulation")
        ready = time.perf_counter() - began
        view.terminate()
    return ready


def _frames(page: LogPage, tab: Any) -> Metric:
    """The most that this machine reaches is what it reaches with nothing in the scene.

    Both take turns, as others may be at work on the machine.
    """
    played: dict[bool, list[float]] = {True: [], False: []}
    for is_shown in (True, False) * TURNS:
        page.server.scene.set_global_visibility(is_shown)
        played[is_shown].append(_played(page, tab))
    page.server.scene.set_global_visibility(True)
    ours, bound = (float(np.median(played[is_shown])) for is_shown in (True, False))
    return Metric(
        "viewer_frames", ours, "1/s", f"the same with an empty scene, {bound:.3g} a second",
        ours / bound, Target("value", ">=", 30.0),
    )  # fmt: skip


def _played(page: LogPage, tab: Any) -> float:
    page.player.jump(0.5 * page.player.end)
    page.player.playing = True
    counted = tab.call("Runtime.evaluate", expression=COUNT, returnByValue=True, awaitPromise=True)[
        "result"
    ]["value"]
    page.player.playing = False
    return float(counted)


def _memory(page: LogPage, tab: Any, loops: int) -> Metric:
    used = [_loop(page, tab.frame) or _heap(tab) for _ in range(loops)]
    name = f"viewer_memory_after_{loops}_loops"
    ratio = used[-1] / used[0]
    return Metric(name, used[-1], "MB", "after the first", ratio, Target("ratio", "<=", 1.1))


def _loop(page: LogPage, frame: Callable[[], None]) -> None:
    for time_s in np.linspace(page.player.start, page.player.end, STOPS):
        page.player.jump(float(time_s))
        frame()


def _heap(tab: Any) -> float:
    """MB."""
    tab.call("HeapProfiler.collectGarbage")
    return float(tab.call("Runtime.getHeapUsage")["usedSize"]) / 1e6
