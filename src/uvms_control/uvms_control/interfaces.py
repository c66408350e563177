"""What a control law and an allocation method must do to take part in the loop.

Any class with these methods will do; it need not derive from the protocol. Its constructor is
called with the vehicle (`uvms_core.vehicle.Vehicle`) and its section of the configuration
(`ControlConfig`, `AllocatorConfig`), in that order. Signals are those of `uvms_core.signals`; they
have been checked when they arrive here. A step that cannot use its inputs raises an error of
`uvms_core.errors` and keeps its state.
"""

from abc import abstractmethod
from typing import Protocol

from uvms_core.signals import (
    Allocation,
    JointCommand,
    JointStates,
    Odometry,
    Reference,
    ThrusterCommand,
    Wrench,
)


class ControlLaw(Protocol):
    """Controls vehicle and arm: estimated state and reference to wrench and joint torques.

    A law that wants to know more has a method `inform(budget, allocation)`, which is called before
    each step: the `DisturbanceBudget` of the tick, with payload and thruster health where the
    observer looks for them, and the `Allocation` of the tick before (None at the first), with what
    the thrusters achieved. A method `prepare(period)`, in s, is called once before the first step:
    there a law works out its gains, or refuses those of the configuration. A law with an attribute
    `stability` (`Stability` or None after a step) has it published and logged. A method
    `hold(joints, stamp)` is called instead of `step` at a tick, ns, without odometry, and gives the
    `JointCommand` that keeps the arm in its place; a law without it has its arm held by `ArmHold`.
    """

    @abstractmethod
    def step(
        self,
        odometry: Odometry,
        joints: JointStates,
        disturbance: Wrench | None,
        reference: Reference,
    ) -> tuple[Wrench, JointCommand]:
        """Commands for the tick at `odometry.stamp`, held until the next.

        Args:
            odometry: estimated pose in map_ned and velocity in the body frame.
            joints: angles and rates of the joints at the same stamp.
            disturbance: wrench that acts ON the vehicle as the observer estimates it, body frame,
                N and N m; None where there is none.
            reference: planned motion that covers this stamp (`uvms_control.sample_reference`).

        Returns:
            Wrench for the vehicle in its body frame about its origin, N and N m, and torques of the
            joints, N m, both with the stamp of `odometry`.
        """
        ...


class AllocationMethod(Protocol):
    """Shares a wrench out among the thrusters.

    An attribute `warning` with a text, where there is one, is logged when the node starts. A method
    `prepare(period)`, in s, where there is one, is called once before the first step. A method
    `inform(budget)`, where there is one, is called before each step with the `DisturbanceBudget`
    of the tick before (None at the first), which tells of thrusters that fail. A method
    `safe(stamp)`, where there is one, says what is commanded where there is no wrench to share out:
    a `ThrusterCommand` without thrust, and its `Allocation`.
    """

    @abstractmethod
    def step(self, wrench: Wrench) -> tuple[ThrusterCommand, Allocation]:
        """Thrusts in N within the thrusters' limits, and what they achieve.

        Args:
            wrench: commanded wrench in the body frame about its origin, N and N m.

        Returns:
            Thrusts (m,) in the order of the vehicle file, and the achieved wrench with what is
            missing, both with the stamp of `wrench`.
        """
        ...
