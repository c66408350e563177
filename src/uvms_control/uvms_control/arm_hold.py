"""The arm is kept where it is while nobody knows where the vehicle is.

Without odometry there is no path to follow, but the encoders are there, and a joint law needs
nothing else. What it lacks is the attitude, which decides what the arm's weight and buoyancy ask of
the joints: the vehicle is taken to be level and at rest, as a hull without thrust soon is, and what
that assumption gets wrong is an unknown load like any other, which the joint observer finds.
"""

import numpy as np

from uvms_control.arm_law import ArmLaw
from uvms_core import checks
from uvms_core.errors import SignalError
from uvms_core.signals import Array, JointCommand, JointStates
from uvms_core.vehicle import Vehicle, joint_limits


class ArmHold:
    """Torques that keep the arm at the posture where it was when the hold began.

    An arm that moves then stops without turning back, as a critically damped loop does: at
    q + q_dot / bandwidth, within the joint limits.

    Args:
        vehicle: its joints.
        arm: the law that moves the arm otherwise; the loads that it has found go on to count.
    """

    def __init__(self, vehicle: Vehicle, arm: ArmLaw) -> None:
        self._names, self._limits = vehicle.joint_names, joint_limits(vehicle)
        self._arm = arm
        self._posture: Array | None = None

    def step(self, joints: JointStates, tick: int) -> JointCommand:
        """Torques from a tick, ns, on.

        Raises:
            SignalError: the joint states are of no use or too old to close a loop with. The hold
                then ends; the next one begins at the posture of its own time.
        """
        try:
            self._arm.check(joints, tick)
            checks.check("joint_states", joints, n=self._names)
        except SignalError:
            self._posture = None
            self._arm.let_go()
            raise
        q, q_dot = self._arm.observe(joints, tick)
        if self._posture is None:
            rest = q + q_dot / self._arm.joints.gains.bandwidth
            self._posture = np.clip(rest, *self._limits)
        return JointCommand(tick, self._arm.hold(tick, self._posture))

    def end(self) -> None:
        """The arm moves again."""
        self._posture = None
