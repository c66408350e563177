"""The controller of vehicle and arm: one tick from estimated state and reference to commands."""

import numpy as np

from uvms_control.arm_law import ArmLaw
from uvms_control.config import ControlConfig
from uvms_control.reference import sample_reference
from uvms_control.tracking_error import TrackingError, tracking_error
from uvms_control.vehicle_controller import VehicleController
from uvms_core import checks
from uvms_core.signals import (
    Array,
    JointCommand,
    JointStates,
    Odometry,
    Reference,
    Wrench,
    to_seconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model, mass_matrix


class Controller:
    """Vehicle by eq. (22), arm by eq. (19); see `VehicleController` and `ArmLaw`."""

    def __init__(self, vehicle: Vehicle, config: ControlConfig):
        """`vehicle` from `uvms_core.vehicle.load_vehicle`."""
        self._config = config
        self._joint_names = vehicle.joint_names
        self._model = build_model(vehicle)
        self.vehicle = VehicleController(self._model, config.vehicle)
        self.arm = ArmLaw(vehicle, self._model, config)
        self.reset()

    def reset(self) -> None:
        """Return to the state before the first step."""
        self._stamp: int | None = None
        self._reference: Reference | None = None  # that was checked
        self.vehicle.reset()
        self.arm.reset()

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
        q, _ = self.arm.observe(joints, odometry.stamp)
        mass = mass_matrix(self._model, q)
        wrench = self._wrench(odometry, mass[:6, :6], disturbance, tracking, dt)
        nu_dot = tracking.acceleration if self._config.enabled else np.zeros(6)
        effort = self.arm.step(odometry, desired, mass, nu_dot, dt)
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
        known = np.zeros(6)
        if self._config.observer and disturbance is not None:
            known = disturbance.wrench
        return self.vehicle.step(odometry, inertia, known, tracking, dt)

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
