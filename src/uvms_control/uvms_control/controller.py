"""The controller of vehicle and arm: one tick from estimated state and reference to commands."""

from dataclasses import replace

import numpy as np

from uvms_control.arm_law import ArmLaw
from uvms_control.config import ControlConfig
from uvms_control.controlled_axes import axes_of
from uvms_control.design.gains import VehicleGains, vehicle_gains
from uvms_control.reference import ReferenceSample, sample_ahead, sample_reference
from uvms_control.tracking_error import tracking_error
from uvms_control.vehicle_law import VehicleLaw, at_reference, joints_ahead
from uvms_core import checks
from uvms_core.signals import (
    Allocation,
    Array,
    DisturbanceBudget,
    JointCommand,
    JointStates,
    Odometry,
    Reference,
    Wrench,
    to_nanoseconds,
    to_seconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model, mass_matrix

ATTITUDE = slice(3, 5)
"""Roll and pitch, along which the arm's weight acts."""


class Controller:
    """Vehicle by `VehicleLaw`, arm by `ArmLaw`: the law `default`.

    Gains follow from the vehicle file and the control period. A law that was not told the period
    (`prepare`) takes that of its first two steps.
    """

    def __init__(self, vehicle: Vehicle, config: ControlConfig):
        """`vehicle` from `uvms_core.vehicle.load_vehicle`."""
        self._config = config
        self._vehicle = vehicle
        self._joint_names = vehicle.joint_names
        self._model = build_model(vehicle)
        self._law = VehicleLaw()
        self._axes = axes_of(vehicle)
        self._effectiveness = np.empty(0)
        self._gains: VehicleGains | None = None
        self._lead = 0
        self.arm = ArmLaw(vehicle, self._model, config)
        self._budget: DisturbanceBudget | None = None
        self.reset()

    def prepare(self, period: float) -> None:
        """Work out the gains for a control period in s.

        Raises:
            ControlSetupError: the loop would not be stable with gains of the configuration.
        """
        self._gains = vehicle_gains(self._vehicle, period, self._config.gains)
        self._lead = to_nanoseconds(float(np.max(self._axes.lag[ATTITUDE])) + 0.5 * period)

    def reset(self) -> None:
        """Return to the state before the first step."""
        self._stamp: int | None = None
        self._reference: Reference | None = None  # that was checked
        self._law.reset()
        self.arm.reset()

    def inform(self, budget: DisturbanceBudget, allocation: Allocation | None) -> None:
        """What explains the disturbance, and what the thrusters gave a tick ago."""
        self._budget = budget
        self.arm.inform(budget)
        if allocation is not None and not np.array_equal(
            allocation.effectiveness, self._effectiveness
        ):
            self._effectiveness = allocation.effectiveness
            self._axes = axes_of(self._vehicle, allocation.effectiveness)

    def step(
        self,
        odometry: Odometry,
        joints: JointStates,
        disturbance: Wrench | None,
        reference: Reference,
    ) -> tuple[Wrench, JointCommand]:
        """Commands for the tick at `odometry.stamp`, held until the next.

        `disturbance`: wrench that acts ON the vehicle as the observer sees it, or None.
        Raises SignalError, naming the value, and keeps its state if an input is bad.
        """
        self._check(odometry, joints, disturbance, reference)
        dt = self._elapsed(odometry.stamp)
        desired = sample_reference(reference, odometry.stamp)
        mass = mass_matrix(self._model, joints.position)
        nu_dot, wrench = np.zeros(6), np.zeros(6)
        if self._config.enabled:
            nu_dot, wrench = self._vehicle_wrench(
                odometry, joints, mass[:6, :6], self._known(disturbance), desired, reference, dt
            )
        effort = self.arm.step(odometry, joints, desired, mass, nu_dot, dt)
        return Wrench(odometry.stamp, wrench), JointCommand(odometry.stamp, effort)

    def _known(self, disturbance: Wrench | None) -> Array:
        """F_dis (6,), what acts ON the vehicle; zeros where it is not fed forward."""
        if disturbance is None or not self._config.observer:
            return np.zeros(6)
        return disturbance.wrench

    def _vehicle_wrench(
        self,
        odometry: Odometry,
        joints: JointStates,
        mass: Array,
        known: Array,
        desired: ReferenceSample,
        reference: Reference,
        dt: float,
    ) -> tuple[Array, Array]:
        """Reference acceleration (6,) in the body frame, and the wrench (6,)."""
        if self._gains is None and dt > 0.0:
            self.prepare(dt)
        ahead = sample_ahead(reference, odometry.stamp, self._lead)
        tracking = tracking_error(odometry, replace(desired, nu_dot=ahead.nu_dot))
        if self._gains is None:
            return tracking.acceleration, -known
        if known.any():
            known = at_reference(
                self._model,
                known,
                self._budget,
                odometry,
                tracking.error,
                self._axes.is_controlled,
                joints.position,
                joints_ahead(joints.position, desired, ahead),
            )
        wrench = self._law.step(
            self._model, self._axes, self._gains, odometry, mass, tracking, known, dt
        )
        return tracking.acceleration, wrench

    def _elapsed(self, stamp: int) -> float:
        """Seconds since the last step; 0 at the first."""
        last, self._stamp = self._stamp, stamp
        return 0.0 if last is None else to_seconds(stamp - last)

    def _check(
        self,
        odometry: Odometry,
        joints: JointStates,
        disturbance: Wrench | None,
        reference: Reference,
    ) -> None:
        if self._stamp is not None:
            checks.later("odometry.stamp", odometry.stamp, self._stamp, "the last one's")
        checks.age("joint_states", joints.stamp, odometry.stamp)
        checks.check("odometry", odometry)
        checks.check("joint_states", joints, n=self._joint_names)
        if disturbance is not None:
            checks.age("disturbance", disturbance.stamp, odometry.stamp)
            checks.check("disturbance", disturbance)
        if reference is not self._reference:
            checks.check("reference", reference, n=self._joint_names)
            self._reference = reference
