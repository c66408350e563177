"""Lag compensation in closed loop: change of command a tick, and roll, in hover and arm_swing."""

from collections.abc import Iterator

import numpy as np
from metrics import Metric

from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_dynamics import quat_to_rpy

SHARES = (0.0, 0.5, 0.8, 1.0)
SETTLED = 1 / 6
"""Share of the run after which it counts."""


def measure(full: bool) -> Iterator[Metric]:
    """Over 60 s with `--full`, else 20 s."""
    for name in ("hover", "arm_swing"):
        for share in SHARES:
            changes, roll, offset = _run(name, share, 60.0 if full else 20.0)
            label = f"thruster_lag_{share:g}_{name}"
            yield Metric(f"{label}_change", _rms(changes), "N", "a tick, each thruster, rms")
            yield Metric(f"{label}_roll", _rms(roll), "deg", "rms")
            yield Metric(f"{label}_roll_greatest", float(np.abs(roll).max()), "deg")
            yield Metric(f"{label}_position", 1e3 * _rms(offset), "mm", "about its mean, rms")


def _run(name: str, share: float, duration: float):
    scenario = load_scenario(name, [f"allocation.lag_compensation={share}"], duration_s=duration)
    vehicle, commands, roll, position = scenario.load_vehicle(), [], [], []

    def observe(tick) -> None:
        commands.append(tick.thruster_command.thrust)
        roll.append(np.degrees(quat_to_rpy(tick.truth.odometry.quaternion)[0]))
        position.append(tick.truth.odometry.position)

    goal = scenario.goal.build(vehicle, scenario.plant)
    simulate(scenario, vehicle, goal, observe=observe)
    first = int(SETTLED * len(commands))
    settled = np.array(position[first:])
    offset = np.linalg.norm(settled - settled.mean(axis=0), axis=1)
    return np.diff(np.array(commands[first:]), axis=0), np.array(roll[first:]), offset


def _rms(values) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
