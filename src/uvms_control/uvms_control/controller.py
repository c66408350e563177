"""The controller of vehicle and arm: one tick from estimated state and reference to commands."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from uvms_control.arm_hold import ArmHold
from uvms_control.arm_law import ArmLaw
from uvms_control.compensation import as_if_held
from uvms_control.config import ControlConfig
from uvms_control.controlled_axes import axes_of
from uvms_control.design.gains import VehicleGains, thrust_delay, vehicle_gains
from uvms_control.hull_swing import HullSwing
from uvms_control.reference import PlannedMotion, ReferenceSample
from uvms_control.stability import StabilityMonitor
from uvms_control.tracking_error import tracking_error
from uvms_control.vehicle_law import VehicleLaw
from uvms_core import checks
from uvms_core.inputs import KEEP
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
from uvms_dynamics import build_model, mass_matrix
from uvms_dynamics.payload import LoadedModel

NOTHING = np.zeros(6)
UNTOLD = np.ones(6)
"""Weight and buoyancy count as part of the disturbance where no budget says what it is made of."""
NO_GAINS = VehicleGains(NOTHING, NOTHING, NOTHING, NOTHING, 0.0)
"""Until the control period is known: what is known is fed forward, and nothing else."""
NO_MONITOR = StabilityMonitor(NOTHING, NOTHING)
"""Likewise: no stability is told."""


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
        self._loaded = LoadedModel(build_model(vehicle))
        self._law = self._make_law(config)
        self._axes = axes_of(vehicle)
        self._effectiveness = np.empty(0)
        self._gains = NO_GAINS
        self._monitor = NO_MONITOR
        self._lead = 0
        self.arm = ArmLaw(vehicle, self._loaded, config)
        self._hold = ArmHold(vehicle, self.arm)
        self._swing = HullSwing()
        self._budget: DisturbanceBudget | None = None
        self.reset()

    def _make_law(self, config: ControlConfig) -> Any:
        """The vehicle's law; it has `step` and `reset`."""
        return VehicleLaw()

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
        self._lacking = NOTHING  # of the last wrench, beyond what the thrusters gave
        self._reference: Reference | None = None  # that was checked
        self._plan: PlannedMotion  # of that
        self._forget_vehicle()
        self._loaded.take(None)
        self.arm.reset()
        self._hold.end()

    def _forget_vehicle(self) -> None:
        """What follows from how the vehicle moved until now."""
        self.stability: Stability | None = None
        self._stamp: int | None = None
        self._law.reset()
        self._swing.reset()
        self.arm.compensation.reset()

    def inform(self, budget: DisturbanceBudget, allocation: Allocation | None) -> None:
        """What explains the disturbance, and what the thrusters gave a tick ago."""
        self._budget = budget
        self._lacking = NOTHING if allocation is None else allocation.residual
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
        self._hold.end()
        dt = self._elapsed(odometry.stamp)
        q, _ = self.arm.observe(joints, odometry.stamp)
        if self._budget is not None:
            self.arm.take(self._budget.payload, odometry)
        planned = self._plan.row(odometry.stamp)
        desired = self._plan.sample(planned)
        if self._config.enabled:
            acts = NOTHING if disturbance is None else disturbance.wrench
            mass, nu_dot, wrench = self._vehicle_share(odometry, q, acts, planned, desired, dt)
        else:
            mass, nu_dot, wrench = mass_matrix(self._loaded.model, q), np.zeros(6), np.zeros(6)
        held = odometry
        if self._config.enabled and not self._axes.is_controlled.all():
            tracking = tracking_error(odometry, desired)
            swing = self._swing.step(
                self._loaded.model,
                (desired.q, desired.q_dot),
                mass,
                tracking,
                self._axes.is_controlled,
                dt,
            )
            held = as_if_held(odometry, tracking, self._axes.is_controlled, swing)
        effort = self.arm.step(odometry, desired, mass, nu_dot, dt, held)
        return Wrench(odometry.stamp, wrench), JointCommand(odometry.stamp, effort)

    def hold(self, joints: JointStates, stamp: int) -> JointCommand:
        """Torques that keep the arm where it is while there is no odometry; see `ArmHold`.

        After more than `KEEP` of it the vehicle's law begins anew, and the arm's goes on.
        """
        command = self._hold.step(joints, stamp)
        if self._stamp is not None and stamp - self._stamp > KEEP:
            self._forget_vehicle()
        return command

    def _vehicle_share(
        self,
        odometry: Odometry,
        q: Array,
        acts: Array,
        planned: Array,
        desired: ReferenceSample,
        dt: float,
    ) -> tuple[Array, Array, Array]:
        """Mass matrix, reference acceleration (6,) and wrench (6,); `stability` is renewed."""
        if self._gains is NO_GAINS and dt > 0.0:
            self.prepare(dt)
        ahead = self._plan.row_ahead(odometry.stamp, self._lead)
        fed = acts if self._config.observer else NOTHING
        restoring = UNTOLD if self._budget is None else self._budget.restoring
        step = self._law.step(
            self._loaded.model,
            self._axes,
            self._gains,
            self._monitor,
            odometry,
            q,
            (planned, ahead),
            (acts, fed, restoring, self._lacking),
            dt,
        )
        if self._monitor is not NO_MONITOR:
            self.stability = Stability(odometry.stamp, *step.figures)
        return step.mass, step.acceleration, step.wrench

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
            self._reference, self._plan = reference, PlannedMotion(reference)
