"""The constants of a vehicle file that trials of a floating vehicle may determine."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from uvms_core.vehicle.overrides import override


@dataclass(frozen=True)
class Parameter:
    """A number of the vehicle file that `uvms identify` tries to fit."""

    name: str  # in plain words
    path: str  # in the file, dotted
    unit: str
    scale: float  # of a noticeable change; the unit of the fit
    worst_error: float  # largest standard error at which it counts as determined
    low: float = -float("inf")
    may_be_absent: bool = False  # refused unless significantly different from 0


_BY_DEPTH = "N m per m"

CANDIDATES = (
    Parameter("static moment x, as CB", "hull.cb_m.0", "m", 1e-3, 1e-3),
    Parameter("static moment y, as CB", "hull.cb_m.1", "m", 1e-3, 1e-3),
    Parameter("static moment z, as CB", "hull.cb_m.2", "m", 1e-3, 1e-3),
    Parameter("volume (net buoyancy)", "hull.volume_m3", "m^3", 1e-5, 1e-5, 1e-6),
    Parameter("heading of the arm's base", "arm.base.rpy_deg.2", "deg", 1.0, 1.5),
    Parameter(
        "pitch moment by depth",
        "tether.moment_per_m_nm.0",
        _BY_DEPTH,
        0.03,
        0.03,
        may_be_absent=True,
    ),
    Parameter(
        "roll moment by depth",
        "tether.moment_per_m_nm.1",
        _BY_DEPTH,
        0.03,
        0.03,
        may_be_absent=True,
    ),
    Parameter("roll damping", "hull.linear_damping.3", "N m s", 0.1, 0.1, 0.0),
    Parameter("pitch damping", "hull.linear_damping.4", "N m s", 0.1, 0.1, 0.0),
    Parameter("added roll inertia", "hull.added_mass.3", "kg m^2", 0.1, 0.1, 0.0),
    Parameter("added pitch inertia", "hull.added_mass.4", "kg m^2", 0.1, 0.1, 0.0),
    Parameter("quadratic roll damping", "hull.quadratic_damping.3", "N m s^2", 1.0, 1.0, 0.0),
    Parameter("quadratic pitch damping", "hull.quadratic_damping.4", "N m s^2", 1.0, 1.0, 0.0),
    Parameter("heave damping", "hull.linear_damping.2", "N s/m", 2.0, 1.5, 0.0),
)
"""All that a slow, free-floating vehicle could determine; the data decides which of them."""


def present(
    data: Any, candidates: Sequence[Parameter] = CANDIDATES
) -> tuple[list[Parameter], dict[str, str]]:
    """Candidates that the file states as a number, and why each of the others cannot be fitted."""
    found: list[Parameter] = []
    skipped: dict[str, str] = {}
    for parameter in candidates:
        value, reason = _look(data, parameter.path)
        if reason:
            skipped[parameter.name] = reason
        elif isinstance(value, list):  # 6 rows: the diagonal
            diagonal = parameter.path.rsplit(".", 1)[1]
            found.append(_with_path(parameter, f"{parameter.path}.{diagonal}"))
        else:
            found.append(parameter)
    return found, skipped


def value_at(data: Any, path: str) -> float:
    """The number at a dotted path of plain data."""
    return float(_look(data, path)[0])


def changed(data: Any, values: Mapping[str, float]) -> Any:
    """Copy of the plain data with numbers replaced, by path."""
    return override(data, values)


def _with_path(parameter: Parameter, path: str) -> Parameter:
    return replace(parameter, path=path)


def _look(data: Any, path: str) -> tuple[Any, str]:
    node, done = data, ""
    for part in path.split("."):
        try:
            node = node[int(part)] if isinstance(node, list) else node[part]
        except (KeyError, IndexError, TypeError, ValueError):
            return None, f"the vehicle file has no {path}" + _word_note(node, done)
        done = f"{done}.{part}" if done else part
    if isinstance(node, str):
        try:  # YAML reads 1e-3 as text
            return float(node), ""
        except ValueError:
            return None, f"{path} is the word `{node}`; write its number to have it fitted"
    return node, ""


def _word_note(node: Any, done: str) -> str:
    return f" ({done} is the word `{node}`)" if isinstance(node, str) else ""
