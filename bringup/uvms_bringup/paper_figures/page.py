"""docs/paper-figures.md from the numbers."""

from collections.abc import Sequence
from dataclasses import dataclass

from uvms_bringup.paper_figures.claims import FIG6, FIG7, FIG8, FIG9, Claim
from uvms_bringup.paper_figures.numbers import Numbers
from uvms_bringup.paper_figures.runs import (
    ARM_ONLY,
    BLIND,
    FREE,
    MANIPULATION,
    OBSERVED,
    RECIPES,
)

PAGE = "paper-figures.md"
NUMBERS = "figures/paper_numbers.json"
HEAD = """\
# The paper's figures

Figures 6 to 10 of the [paper](paper.md), made again by `make figures` from runs of this project,
each beside what the paper says about it (in our words) and the number here that answers it. Where
the paper gives a number, that is the limit; else it is ours. Reference vehicle and path are ours,
too, since the paper's tables are lost: shapes and orders of magnitude can agree, values cannot.
Disturbances are as observed, from 1 s on; attitudes are true; the tool is where the vehicle's own
estimate puts it, and its true place is off by the drift of dead reckoning besides
([getting-started.md](getting-started.md#read-the-summary)).
"""
COLUMNS = "| the paper says | here | | limit | holds |\n|---|---|---|---|---|"


@dataclass(frozen=True)
class Section:
    """A figure of the page."""

    number: int
    title: str
    shows: str  # alternative text of the picture
    text: str
    runs: tuple[str, ...]
    claims: Sequence[Claim] = ()

    @property
    def picture(self) -> str:
        """Path of the picture below docs/."""
        return f"figures/paper_fig{self.number}.png"


SECTIONS = (
    Section(
        6,
        "the arm's added mass",
        "Added inertia of the arm about its swing and its shoulder axis against the elbow angle",
        "Here as inertia about the first two joints, H_A = Σ J_iᵀ M_A,i J_i"
        " ([added-mass.md](added-mass.md#the-arms-added-inertia)). No run is needed.",
        (),
        FIG6,
    ),
    Section(
        7,
        "the arm moves, nobody controls the vehicle",
        "Joints, roll and pitch, restoring moments and coupling forces without control",
        "The joints follow their reference, the thrusters are off.",
        (FREE,),
        FIG7,
    ),
    Section(
        8,
        "control with and without the observer",
        "Joints, restoring moments, and roll and pitch with and without the observer",
        "The same motion under control. Without the observer the disturbance is not fed forward.",
        (BLIND, OBSERVED),
        FIG8,
    ),
    Section(
        9,
        "precise manipulation",
        "Path of the tool, joints, attitude, restoring and coupling forces and moments",
        "900 s in three phases. The second run has the arm follow the same path alone, from a"
        " vehicle held still.",
        (MANIPULATION, ARM_ONLY),
        FIG9,
    ),
    Section(
        10,
        "the manipulation in 3-D",
        "Vehicle and arm at the beginning and at the end of each of the three phases",
        "The run of Fig. 9 at the beginning and at the end of each phase; `uvms view` shows it"
        " moving.",
        (MANIPULATION,),
    ),
)


def page(numbers: Numbers) -> str:
    """The whole page."""
    held = [claim.holds(numbers) for section in SECTIONS for claim in section.claims]
    count = f"{sum(held)} of {len(held)} numbers are within their limits."
    return "\n".join([HEAD, count, *(_section(section, numbers) for section in SECTIONS)])


def _section(section: Section, numbers: Numbers) -> str:
    lines = ["", f"## Fig. {section.number}: {section.title}", "", section.text]
    if section.runs:
        lines += ["", "```", *(RECIPES[name].command for name in section.runs), "```"]
    lines += ["", f"![{section.shows}]({section.picture})"]
    if section.claims:
        lines += ["", COLUMNS, *(_row(claim, numbers) for claim in section.claims)]
    reasons = [f"{c.what}: {c.unless}".rstrip(": ") for c in section.claims if not c.holds(numbers)]
    lines += ["", *(f"- Not so, {reason}" for reason in reasons)] if reasons else []
    return "\n".join(lines) + ("\n" if section is SECTIONS[-1] else "")


def _row(claim: Claim, numbers: Numbers) -> str:
    value = f"{numbers[claim.key]:.3g} {claim.unit}".strip().replace(" °", "°")
    limit = f"{claim.bound} {claim.unit}".strip().replace(" °", "°")
    limit = limit.replace(">=", "≥").replace("<=", "≤")
    cells = (claim.says, claim.what, value, limit, "yes" if claim.holds(numbers) else "**no**")
    return f"| {' | '.join(cells)} |".replace("|  |", "| |")
