"""The page of the paper's figures is that of the present code."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from uvms_bringup.campaign.bound import Bound
from uvms_bringup.errors import RunError
from uvms_bringup.paper_figures.__main__ import main
from uvms_bringup.paper_figures.numbers import BEGINNING_S, beginning
from uvms_bringup.paper_figures.page import NUMBERS, PAGE, SECTIONS, page
from uvms_bringup.paper_figures.runs import FREE, OBSERVED, RECIPES, read, simulated

DOCS = Path(__file__).parents[2] / "docs"
STORED = json.loads((DOCS / NUMBERS).read_text(encoding="utf-8"))
AGAIN = "`make figures` makes the paper's figures again"
CLAIMS = [claim for section in SECTIONS for claim in section.claims]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The beginning of every run."""
    place = tmp_path_factory.mktemp("runs")
    simulated(place, BEGINNING_S)
    return place


def test_the_runs_still_begin_as_they_did(folder):
    now = beginning(read(folder))
    assert now.keys() == STORED["beginning"].keys(), AGAIN
    for name, value in now.items():
        assert value == pytest.approx(STORED["beginning"][name], rel=0.05, abs=2e-3), (name, AGAIN)


def test_the_page_is_made_of_the_stored_numbers():
    assert (DOCS / PAGE).read_text(encoding="utf-8") == page(STORED["numbers"]), AGAIN
    other = {name: 1.1 * value for name, value in STORED["numbers"].items()}
    assert page(other) != page(STORED["numbers"])


def test_every_figure_is_there_and_in_the_page():
    shown = re.findall(r"!\[[^]]+\]\(([^)]+)\)", (DOCS / PAGE).read_text(encoding="utf-8"))
    assert shown == [f"figures/paper_fig{number}.png" for number in range(6, 11)]
    for path in shown:
        with Image.open(DOCS / path) as picture:
            assert min(picture.size) > 300
            assert np.std(np.asarray(picture.convert("L"))) > 5.0  # not blank
    assert {path.name for path in (DOCS / "figures").glob("paper_fig*")} == {
        Path(path).name for path in shown
    }


def test_what_does_not_hold_says_no_and_why():
    text, rows = page(STORED["numbers"]), 0
    for claim in CLAIMS:
        if not claim.holds(STORED["numbers"]):
            rows += 1
            assert claim.unless
            assert claim.unless in text
    assert text.count("| **no** |") == rows
    assert f"{len(CLAIMS) - rows} of {len(CLAIMS)} numbers" in text


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.key)
def test_a_claim_can_fail(claim):
    """A number beyond each end of its limits, or one that is not known, does not hold."""
    for end, step in ((claim.bound.min, -1.0), (claim.bound.max, 1.0)):
        if end is not None:
            assert not claim.holds({claim.key: end + step})
            assert claim.holds({claim.key: end})
    assert not claim.holds({claim.key: float("nan")})
    assert not replace(claim, bound=Bound(max=-1e9)).holds(STORED["numbers"])


def test_a_run_of_something_else_is_refused(folder, tmp_path, capsys):
    """No figure is drawn of a run that its caption does not name."""
    for name in RECIPES:
        (tmp_path / name).symlink_to(folder / name)
    (tmp_path / FREE).unlink()
    (tmp_path / FREE).symlink_to(folder / OBSERVED)
    with pytest.raises(RunError, match=r"is no run of .*enabled=false.*another control"):
        read(tmp_path)
    assert main(["--from", str(tmp_path), "--docs", str(tmp_path / "docs")]) == 2
    assert "control.enabled=false" in capsys.readouterr().err
    assert not (tmp_path / "docs").exists()
    (tmp_path / FREE).unlink()
    with pytest.raises(RunError, match=f"{FREE}: holds no run"):
        read(tmp_path)
