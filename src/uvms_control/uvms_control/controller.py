"""The controller of vehicle and arm: one tick from estimated state and reference to commands."""

import numpy as np

from uvms_control.arm_controller import ArmController, floating_inertia
from uvms_control.compensation import EndEffectorCompensation, JointCorrection
from uvms_control.config import ControlConfig
from uvms_control.reference import ReferenceSample, sample_reference
from uvms_control.stability import StabilityMonitor
from uvms_control.tracking_error import TrackingError, tracking_error
from uvms_control.vehicle_controller import VehicleController
from uvms_control.vehicle_data import effort_limits
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
    to_seconds,
)
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_dynamics import (
    build_model,
    hull_bias_wrench,
    inverse_dynamics,
    joint_passive_torque,
    mass_matrix,
)


class Controller:
    """Vehicle by eq. (22), arm by eq. (19); see `VehicleController` and `ArmController`."""

    def __init__(self, vehicle: Vehicle, config: ControlConfig):
        """`vehicle` from `uvms_core.vehicle.load_vehicle`."""
        self._config = config
        self._n = vehicle.n_joints
        self._joint_names = vehicle.joint_names
        self._model = build_model(vehicle)
        self.vehicle = VehicleController(self._model, config.vehicle)
        lower, upper = joint_limits(vehicle)
        self._away_from_stops = 0.5 * (lower + upper)
        self.arm = ArmController(config.arm, effort_limits(vehicle))
        self.compensation = EndEffectorCompensation(self._model, config.compensation, lower, upper)
        law = self.vehicle.law
        self._monitor = StabilityMonitor(law.stiffness, law.damping)
        self.reset()

    def reset(self) -> None:
        """Return to the state before the first step."""
        self.stability: Stability | None = None
        self._lacking = np.zeros(6)  # of the last wrench, beyond the thrusters' limits
        self._stamp: int | None = None
        self._reference: Reference | None = None  # that was checked
        self.vehicle.reset()
        self.arm.reset()
        self.compensation.reset()

    def inform(self, budget: DisturbanceBudget | None, allocation: Allocation | None) -> None:
        """What the thrusters made of the last wrench (None at the first tick)."""
        self._lacking = np.zeros(6) if allocation is None else allocation.residual

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
        tracking = tracking_error(odometry, desired)
        mass = mass_matrix(self._model, joints.position)
        wrench = self._wrench(odometry, mass[:6, :6], disturbance, tracking, dt)
        feed_forward = self._arm_model_torque(odometry, joints, desired, tracking)
        inertia = floating_inertia(mass)
        effort = self._joint_effort(odometry, joints, inertia, feed_forward, desired, dt)
        return Wrench(odometry.stamp, wrench), JointCommand(odometry.stamp, effort)

    def _wrench(
        self,
        odometry: Odometry,
        inertia: Array,
        disturbance: Wrench | None,
        tracking: TrackingError,
        dt: float,
    ) -> Array:
        if not self._config.enabled:
            return np.zeros(6)
        acts = np.zeros(6) if disturbance is None else disturbance.wrench
        known = acts if self._config.observer else np.zeros(6)
        wrench = self.vehicle.step(odometry, inertia, known, tracking, dt)
        bias = hull_bias_wrench(self._model, odometry.nu)
        needed = inertia @ tracking.acceleration + bias - acts
        given = wrench - self._lacking
        self.stability = self._monitor.at(
            odometry.stamp, tracking.error, tracking.rate, inertia, needed, given
        )
        return wrench

    def _joint_effort(
        self,
        odometry: Odometry,
        joints: JointStates,
        inertia: Array,
        feed_forward: Array,
        desired: ReferenceSample,
        dt: float,
    ) -> Array:
        correction = self._correction(odometry, desired, dt)
        q_dot = desired.q_dot + correction.rate
        error = desired.q + correction.angle - joints.position
        steered = self.arm.steered_rate(error, q_dot, dt)
        friction = joint_passive_torque(self._model, self._away_from_stops, steered)
        load = feed_forward - self._config.arm.friction_compensation * friction
        return self.arm.effort(error, q_dot - joints.velocity, inertia, load, dt)

    def _correction(
        self, odometry: Odometry, desired: ReferenceSample, dt: float
    ) -> JointCorrection:
        if self._config.enabled and self._config.compensate_vehicle_motion:
            return self.compensation.step(odometry, desired, dt)
        return JointCorrection(np.zeros(self._n), np.zeros(self._n))

    def _arm_model_torque(
        self,
        odometry: Odometry,
        joints: JointStates,
        desired: ReferenceSample,
        tracking: TrackingError,
    ) -> Array:
        """K Delta-u of eq. (19): what the model needs for the reference acceleration (n,) N m.

        Weight, buoyancy, drag and the vehicle's reference acceleration are in it, friction is not.
        The vehicle's feedback acceleration is left out: what it really causes is uncertain when a
        disturbance is not fed forward or a thruster saturates.
        """
        vehicle = tracking.acceleration if self._config.enabled else np.zeros(6)
        whole = inverse_dynamics(
            self._model,
            odometry.quaternion,
            odometry.nu,
            vehicle,
            joints.position,
            joints.velocity,
            desired.q_ddot,
        )
        return whole[6:]

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
