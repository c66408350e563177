"""A run at a few hundred instants: its plots, the tool's path, and what sets the scales."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uvms_bringup.viewer.moment import Moment, Posture, tool_pose
from uvms_core.rotations import quat_to_rpy
from uvms_core.signals import Array
from uvms_core.vehicle.vehicle import Vehicle

TURN_RATE = 2.0 * np.pi
"""Of a propeller at its greatest thrust, rad/s: slow enough for the eye; the true speed of the
shaft is not known."""


@dataclass(frozen=True)
class Plot:
    """Curves over the overview's times; NaN where nobody says."""

    title: str
    unit: str
    names: tuple[str, ...]
    values: Array  # (k, j)


class Overview:
    """Curves of a run at times (k,), s."""

    def __init__(self, vehicle: Vehicle, moments: Sequence[Moment]) -> None:
        self._vehicle, self._moments = vehicle, moments
        self.times = np.array([moment.time for moment in moments])
        self.tool = self._tool()
        self.thrust = self._thrust()
        self.turned = self._turned()

    @property
    def force_scale(self) -> float:
        """The greatest force or thrust of the run, N; 1 where there is none."""
        parts = [self._force(part) for part in ("restoring", "coupling", "external")]
        sizes = [np.linalg.norm(part, axis=1) for part in parts]
        every = np.concatenate([np.abs(self.thrust).ravel(), *sizes])
        finite = every[np.isfinite(every)]
        return float(finite.max()) if finite.size and finite.max() > 0.0 else 1.0

    @property
    def middle(self) -> Array:
        """What the run is around, (3,) m in map_ned."""
        here = self.tool[np.isfinite(self.tool).all(axis=1)]
        return 0.5 * (here.min(axis=0) + here.max(axis=0)) if len(here) else np.zeros(3)

    def plots(self) -> tuple[Plot, ...]:
        """What the page shows below the scene."""
        names = tuple(item.name for item in self._vehicle.thrusters)
        return (
            Plot("tool off its target", "mm", ("error",), 1e3 * self._errors()),
            Plot("attitude", "deg", ("roll", "pitch"), self._attitude()),
            Plot("thrust", "N", names, self.thrust),
            Plot("disturbance", "N", ("restoring", "coupling", "external"), self._disturbance()),
            Plot("estimate off the truth", "mm", ("position",), 1e3 * self._navigation()),
        )

    def _tool(self) -> Array:
        return np.array([_tool(self._vehicle, moment) for moment in self._moments]).reshape(-1, 3)

    def _thrust(self) -> Array:
        none = np.full(len(self._vehicle.thrusters), np.nan)
        given = [moment.thrusts for moment in self._moments]
        return np.array([none if one is None else one.thrust for one in given])

    def _turned(self) -> Array:
        """How far each propeller has turned since the start, (k, m) rad."""
        limits = np.array([item.greatest_n for item in self._vehicle.thrusters])
        rates = TURN_RATE * np.nan_to_num(self.thrust) / limits
        steps = 0.5 * np.diff(self.times)[:, None] * (rates[1:] + rates[:-1])
        return np.vstack([np.zeros((1, len(limits))), np.cumsum(steps, axis=0)])

    def _errors(self) -> Array:
        wanted = [moment.target for moment in self._moments]
        off = [
            np.full(3, np.nan) if target is None else tool - target
            for tool, target in zip(self.tool, wanted, strict=True)
        ]
        return np.asarray(np.linalg.norm(np.array(off), axis=1, keepdims=True))

    def _attitude(self) -> Array:
        shown = [moment.true or moment.estimated for moment in self._moments]
        return np.degrees(
            [[np.nan] * 2 if one is None else quat_to_rpy(one.quaternion)[:2] for one in shown]
        )

    def _force(self, part: str) -> Array:
        given = [moment.forces for moment in self._moments]
        return np.array([np.full(3, np.nan) if one is None else getattr(one, part)
                         for one in given])  # fmt: skip

    def _disturbance(self) -> Array:
        parts = [self._force(part) for part in ("restoring", "coupling", "external")]
        return np.column_stack([np.linalg.norm(part, axis=1) for part in parts])

    def _navigation(self) -> Array:
        return np.array([[_apart(moment.true, moment.estimated)] for moment in self._moments])


def _tool(vehicle: Vehicle, moment: Moment) -> Array:
    shown = moment.true or moment.estimated
    return np.full(3, np.nan) if shown is None else tool_pose(vehicle, shown)[0]


def _apart(one: Posture | None, other: Posture | None) -> float:
    if one is None or other is None:
        return float("nan")
    return float(np.linalg.norm(one.position - other.position))
