"""Figures with several runs laid over one another, each in its own colour."""

from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.report import style
from uvms_core.signals import Array

Runs = Mapping[str, Analysis]
Panel = tuple[str, str, Callable[[Analysis], tuple[Array, Array]]]
"""Title, unit, and time (k,) with values (k,) of a run."""


def _panels(runs: Runs, panels: list[Panel]) -> Figure:
    figure = style.new_figure(0.6 + 1.6 * len(panels))
    rows = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (title, unit, values_of) in zip(rows, panels, strict=True):
        for index, (name, run) in enumerate(runs.items()):
            time, values = values_of(run)
            color = style.COLORS[index % len(style.COLORS)]
            axes.plot(
                style.thin(time), style.thin(values), color=color, linewidth=0.9, alpha=0.85,
                label=name,
            )  # fmt: skip
        axes.set_title(title)
        axes.set_ylabel(unit)
    style.legend(rows[0])
    rows[-1].set_xlabel("t / s")
    return figure


def attitude(runs: Runs) -> Figure:
    """True roll, pitch and yaw."""

    def angle(index: int) -> Callable[[Analysis], tuple[Array, Array]]:
        return lambda run: (run.truth.time, run.rpy_deg[:, index])

    names = ("roll φ", "pitch θ", "yaw ψ")
    return _panels(runs, [(name, "deg", angle(k)) for k, name in enumerate(names)])


def tracking(runs: Runs) -> Figure:
    """Distance of the end effector from its target, and of the vehicle from its reference."""

    def tool(run: Analysis) -> tuple[Array, Array]:
        time = run.truth.time[run.target.index]
        return time, 1e3 * np.linalg.norm(run.end_effector_error, axis=1)

    def vehicle(run: Analysis) -> tuple[Array, Array]:
        time, error = run.vehicle_error
        return time, 1e3 * np.linalg.norm(error, axis=1)

    return _panels(
        runs,
        [("end effector off its target", "mm", tool), ("vehicle off its reference", "mm", vehicle)],
    )


def thrust(runs: Runs) -> Figure:
    """Length of the vector of all thrusts, and of the wrench that they do not deliver."""

    def total(run: Analysis) -> tuple[Array, Array]:
        return run.allocation.time, np.linalg.norm(run.allocation.thrust, axis=1)

    def missing(run: Analysis) -> tuple[Array, Array]:
        return run.allocation.time, np.linalg.norm(run.allocation.residual[:, :3], axis=1)

    return _panels(
        runs,
        [("thrust, all thrusters", "N", total), ("force commanded, not delivered", "N", missing)],
    )


def disturbance(runs: Runs) -> Figure:
    """Length of the true restoring and coupling wrench on the vehicle."""

    def part(half: slice) -> Callable[[Analysis], tuple[Array, Array]]:
        def values(run: Analysis) -> tuple[Array, Array]:
            wrench = run.disturbance.restoring + run.disturbance.coupling
            # At the first sample no joint torque is applied yet, and the arm starts to fall.
            return run.disturbance.time[1:], np.linalg.norm(wrench[1:, half], axis=1)

        return values

    return _panels(
        runs,
        [
            ("self-disturbance, force", "N", part(slice(0, 3))),
            ("self-disturbance, moment", "N m", part(slice(3, 6))),
        ],
    )


FIGURES: dict[str, tuple[str, Callable[[Runs], Figure]]] = {
    "attitude": ("True attitude of the vehicle.", attitude),
    "tracking": ("Errors of end effector and vehicle.", tracking),
    "thrust": ("Thrust as allocated.", thrust),
    "disturbance": ("Restoring and coupling wrench on the vehicle, true.", disturbance),
}
