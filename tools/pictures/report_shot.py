"""The picture of the report: the top of its page and a plot, as a browser shows them."""

import io
import re
import sys
import tempfile
from base64 import b64decode
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "uvms_bringup"))
from browser import browser_tab

ARGUMENTS = ["arm_swing", "--duration", "52"]
"""Of `uvms simulate`; the run is that of the tour."""
WIDTH, GAP = 1100, 12
"""Of the page, and between its parts in the picture, pixels."""
CARDS = "document.querySelector('section.cards')"
PLOT = "document.getElementById('plot-tool_error').closest('section')"
"""What the upper part ends with, and the plots below it."""
EDGE = (150, 160, 170)
BOX = (
    "(e => { const r = e.getBoundingClientRect(); return [scrollY + r.top, scrollY + r.bottom]; })"
)
QUESTION = re.compile(r"<h2>(.*?)</h2>")
CARD = re.compile(r'<div class="card"><h3>(.*?)</h3><p class="big">([-\d.eg]+) <span>(.*?)</span>')


def told(page: str) -> dict[str, Any]:
    """What the picture shows of a report's HTML: its questions, and its key figures with units."""
    figures = {title: [float(value), unit] for title, value, unit in CARD.findall(page)}
    return {"questions": QUESTION.findall(page), "figures": figures}


def photograph(report: Path, picture: Path) -> Path:
    """Write the picture of a report."""
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile,
        browser_tab(profile, (WIDTH, 1000)) as tab,
    ):
        tab.width(WIDTH)
        tab.open(report.as_uri())
        tab.colours("light")
        upper = _part(tab, 0.0, _box(tab, CARDS)[1] + GAP)  # before its bar goes along with us
        tab.evaluate(f"{PLOT}.scrollIntoView({{block: 'center'}})")
        drawn = f"[...{PLOT}.querySelectorAll('.canvas')].every(e => e.querySelector('canvas'))"
        tab.wait(lambda: tab.evaluate(drawn), "the plots")
        tab.frame()
        top, bottom = _box(tab, PLOT)
        lower = _part(tab, top, bottom)
    edge = np.full((2, WIDTH, 3), EDGE, dtype=np.uint8)
    Image.fromarray(np.vstack([upper, edge, lower])).quantize(128).save(picture, optimize=True)
    return picture


def _box(tab: Any, element: str) -> tuple[float, float]:
    """Top and bottom of an element in the document, pixels."""
    top, bottom = tab.evaluate(f"{BOX}({element})")
    return top, bottom


def _part(tab: Any, top: float, bottom: float) -> np.ndarray:
    clip = {"x": 0, "y": top, "width": WIDTH, "height": bottom - top, "scale": 1}
    answer = tab.call("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)
    return np.asarray(Image.open(io.BytesIO(b64decode(answer["data"]))).convert("RGB"))
