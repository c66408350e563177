"""Navigation from the truth: the simulation's own state, as the baseline of all navigation.

It is the only reader of the truth in the loop, and only where `navigation.source` says so.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from uvms_core import topics
from uvms_core.part import Output, Part
from uvms_core.sensors import inertial
from uvms_core.signals import Odometry
from uvms_core.tick_gate import Same, Tick
from uvms_core.vehicle import Vehicle
from uvms_observer.arrivals import navigation_inputs

EXACT = 1e-6
"""Std of each value, m, rad, m/s and rad/s: far below any sensor's, and far above the rounding of
numbers at the size of a map (1e6 m x 2e-16)."""


class TruthPart(Part):
    """Odometry from `ground_truth/odometry`, at the same ticks as a filter gives it.

    It waits for the sensors' samples and the thrusts as a filter does and ignores them, so that a
    run differs from one with a filter in nothing but the estimate.

    Args:
        vehicle: its sensors.
        period: of the control loop, ns.
    """

    outputs = topics.NODES[topics.NAVIGATION].outputs

    def __init__(self, vehicle: Vehicle, period: int) -> None:
        self.every = period
        self.trigger = inertial(vehicle).topic
        self.inputs = {**navigation_inputs(vehicle, period), topics.TRUE_ODOMETRY: Same()}
        self.estimate: Odometry | None = None
        """The last one."""

    def step(self, tick: Tick) -> Iterator[Output]:
        """The truth of the tick, as certain as numbers are."""
        truth: Odometry = tick[topics.TRUE_ODOMETRY.name]
        covariance = EXACT**2 * np.eye(6)
        self.estimate = replace(
            truth, pose_covariance=covariance, twist_covariance=covariance.copy()
        )
        yield topics.ODOMETRY, self.estimate

    def restart(self, reason: str) -> None:
        """There is no state to lose."""
        self.estimate = None
