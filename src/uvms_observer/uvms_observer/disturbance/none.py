"""Observer `none`: sees no disturbance, as the baseline that an observer is compared with."""

import numpy as np

from uvms_core import checks
from uvms_core.signals import DisturbanceBudget, JointStates, Odometry, Wrench
from uvms_core.vehicle import Vehicle
from uvms_observer.disturbance.observer_config import ObserverConfig


class NoObserver:
    """Says at every stamp that nothing acts on the vehicle besides its thrusters."""

    def __init__(self, vehicle: Vehicle, config: ObserverConfig) -> None:
        self._joint_names = vehicle.joint_names
        self._stamp: int | None = None

    def step(
        self, odometry: Odometry, joints: JointStates, achieved: Wrench | None
    ) -> tuple[DisturbanceBudget, Wrench]:
        """Zero in all parts, at the estimate's stamp.

        Raises:
            SignalError: stamps do not increase, or a signal is malformed.
        """
        if self._stamp is not None:
            checks.later("odometry.stamp", odometry.stamp, self._stamp, "the last one's")
        checks.check("odometry", odometry)
        checks.check("joint_states", joints, n=self._joint_names)
        self._stamp, none = odometry.stamp, np.zeros(6)
        budget = DisturbanceBudget(odometry.stamp, none, none.copy(), none.copy())
        return budget, Wrench(odometry.stamp, none.copy())
