"""The controller of vehicle and arm: one tick from estimated state and reference to commands."""

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from uvms_control.arm_law import ArmLaw
from uvms_control.compensation import as_if_held
from uvms_control.config import ControlConfig
from uvms_control.controlled_axes import axes_of
from uvms_control.design.gains import VehicleGains, thrust_delay, vehicle_gains
from uvms_control.reference import ReferenceSample, sample_ahead, sample_reference
from uvms_control.stability import StabilityMonitor
from uvms_control.tracking_error import TrackingError, tracking_error
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
    Stability,
    Wrench,
    to_nanoseconds,
    to_seconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model, hull_bias_wrench, mass_matrix


class Controller:
    """Vehicle by `VehicleLaw`, arm by `ArmLaw`: the law `default`.

    Gains follow from the vehicle file and the control period. A law that was not told the period
    (`prepare`) takes that of its first two steps.
    """

    ignores: ClassVar[Mapping[str, str]] = {"vehicle": "the law paper; this one has gains"}
    """Sections of the configuration that are another law's; see `PluginConfig.resolved`."""

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
        self._monitor: StabilityMonitor | None = None
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
        whole = self._gains.stiffness + self._gains.righting
        self._monitor = StabilityMonitor(whole, self._gains.damping)
        self._lead = to_nanoseconds(thrust_delay(self._axes, period, self._config.gains))
        self.arm.prepare(period)

    def reset(self) -> None:
        """Return to the state before the first step."""
        self.stability: Stability | None = None
        self._lacking = np.zeros(6)  # of the last wrench, beyond what the thrusters gave
        self._stamp: int | None = None
        self._reference: Reference | None = None  # that was checked
        self._law.reset()
        self.arm.reset()

    def inform(self, budget: DisturbanceBudget, allocation: Allocation | None) -> None:
        """What explains the disturbance, and what the thrusters gave a tick ago."""
        self._budget = budget
        self.arm.inform(budget)
        self._lacking = np.zeros(6) if allocation is None else allocation.residual
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
        q, _ = self.arm.observe(joints, odometry.stamp)
        mass = mass_matrix(self._model, q)
        nu_dot, wrench, held = np.zeros(6), np.zeros(6), odometry
        if self._config.enabled:
            inertia = np.ascontiguousarray(mass[:6, :6])
            acts = np.zeros(6) if disturbance is None else disturbance.wrench
            known = acts if self._config.observer else np.zeros(6)
            tracking, wrench = self._vehicle_wrench(
                odometry, q, inertia, known, desired, reference, dt
            )
            nu_dot = tracking.acceleration
            held = as_if_held(odometry, tracking, self._axes.is_controlled)
            self.stability = self._judge(odometry, inertia, acts, tracking, wrench)
        effort = self.arm.step(odometry, desired, mass, nu_dot, dt, held)
        return Wrench(odometry.stamp, wrench), JointCommand(odometry.stamp, effort)

    def _judge(
        self,
        odometry: Odometry,
        mass: Array,
        acts: Array,
        tracking: TrackingError,
        wrench: Array,
    ) -> Stability | None:
        """Lyapunov function and condition of eq. (27)-(29); None before the gains are known.

        acts (6,): what acts ON the vehicle at its actual attitude, whether it is fed forward or
        not. What the thrusters lacked a tick ago counts as lacking now.
        """
        if self._monitor is None:
            return None
        needed = mass @ tracking.acceleration + hull_bias_wrench(self._model, odometry.nu) - acts
        given = wrench - self._lacking
        return self._monitor.at(odometry.stamp, tracking.error, tracking.rate, mass, needed, given)

    def _vehicle_wrench(
        self,
        odometry: Odometry,
        q: Array,
        mass: Array,
        known: Array,
        desired: ReferenceSample,
        reference: Reference,
        dt: float,
    ) -> tuple[TrackingError, Array]:
        """Errors with the reference acceleration, and the wrench (6,)."""
        if self._gains is None and dt > 0.0:
            self.prepare(dt)
        ahead = sample_ahead(reference, odometry.stamp, self._lead)
        tracking = tracking_error(odometry, replace(desired, nu_dot=ahead.nu_dot))
        if self._gains is None:
            return tracking, -known
        if known.any():
            known = at_reference(
                self._model,
                known,
                self._budget,
                odometry,
                tracking.error,
                self._axes.is_controlled,
                q,
                joints_ahead(q, desired, ahead),
            )
        wrench = self._law.step(
            self._model, self._axes, self._gains, odometry, mass, tracking, known, dt
        )
        return tracking, wrench

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
        self.arm.check(joints, odometry.stamp)
        checks.check("odometry", odometry)
        checks.check("joint_states", joints, n=self._joint_names)
        if disturbance is not None:
            checks.age("disturbance", disturbance.stamp, odometry.stamp)
            checks.check("disturbance", disturbance)
        if reference is not self._reference:
            checks.check("reference", reference, n=self._joint_names)
            self._reference = reference
