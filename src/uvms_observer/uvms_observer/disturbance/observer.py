"""The self-disturbance observer, eq. (21): what acts on the vehicle besides its thrusters."""

import numpy as np

from uvms_core import checks
from uvms_core.signals import (
    Allocation,
    Array,
    DisturbanceBudget,
    JointStates,
    Odometry,
    ThrusterHealth,
    Wrench,
    to_seconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model, coupling_wrench, restoring_wrench
from uvms_dynamics.tracking import TrackingFilter
from uvms_observer.disturbance.external import ExternalWrenchObserver, Moment
from uvms_observer.disturbance.observer_config import ObserverConfig
from uvms_observer.disturbance.thrust_lag import ThrustLag
from uvms_observer.health import ThrusterMonitor

NOT_MOVING = np.zeros(6)
NOT_KNOWN = np.zeros(6)
"""Standard deviation of the wrench of a single interval: it is worked out from the steps."""


class DisturbanceObserver:
    """Restoring and coupling wrench of the estimated state through the model, and the remainder.

    Eq. (21): F_dis = restoring(R, q) + coupling(nu, nu_dot, q, q_dot, q_ddot), a wrench that acts
    ON the vehicle, body frame, about its origin. Accelerations come from tracking filters, the
    external wrench from a momentum residual. The water is assumed at rest: the effect of a current
    is part of the external wrench.

    Args:
        vehicle: model, thruster lag, encoder noise.
        config: switch and bandwidths.
    """

    def __init__(self, vehicle: Vehicle, config: ObserverConfig) -> None:
        self._model = build_model(vehicle)
        self._config = config
        self._joint_names = vehicle.joint_names
        self._encoder_variances = _encoder_variances(vehicle)
        self._joints = TrackingFilter(3, config.joint_jerk_rad_s3)
        self._linear = TrackingFilter(2, config.vehicle_jerk_m_s3)
        self._angular = TrackingFilter(2, config.vehicle_jerk_rad_s3)
        self._lag = ThrustLag(vehicle)
        self._external = ExternalWrenchObserver(self._model, config.external_bandwidth_rad_s)
        self._monitor = ThrusterMonitor(vehicle)
        self._health = self._monitor.health
        self._allocation: Allocation | None = None
        self._stamp: int | None = None
        self._before: Moment | None = None

    def inform(self, allocation: Allocation | None) -> None:
        """Thrusts of the tick before, one by one, and the shares that they were counted with."""
        self._allocation = allocation

    def step(
        self, odometry: Odometry, joints: JointStates, achieved: Wrench | None
    ) -> tuple[DisturbanceBudget, Wrench]:
        """The budget at this stamp, and the total that the controller takes off its wrench.

        The budget's coupling has the vehicle's own acceleration in it, as eq. (16) and the plant
        have. The total does not: the controller's M covers it, so that the arm's inertia counts
        once.

        Args:
            odometry: estimate at this stamp.
            joints: encoders at the same stamp, or shortly before.
            achieved: wrench of the thrusts commanded at the stamp before; None if not known, which
                leaves the external wrench as it was.

        Raises:
            SignalError: stamps do not increase or are too far apart, a value is not finite or has
                a wrong shape. The observer is as it was before.
        """
        self._check(odometry, joints, achieved)
        now = Moment(odometry.quaternion, odometry.nu, joints.position, joints.velocity)
        dt = 0.0 if self._stamp is None else to_seconds(odometry.stamp - self._stamp)
        external = self._observe_external(dt, now, achieved)
        nu_dot, q_ddot = self._accelerations(dt, odometry, joints)
        self._stamp, self._before = odometry.stamp, now
        restoring = restoring_wrench(self._model, now.quaternion, now.q)
        coupling = coupling_wrench(self._model, now.nu, nu_dot, now.q, now.q_dot, q_ddot)
        held = coupling_wrench(self._model, now.nu, NOT_MOVING, now.q, now.q_dot, q_ddot)
        total = restoring + held + (external if self._config.external else 0.0)
        budget = DisturbanceBudget(
            odometry.stamp, restoring, coupling, external, thrusters=self._health
        )
        return budget, Wrench(odometry.stamp, total)

    def _observe_external(self, dt: float, now: Moment, achieved: Wrench | None) -> Array:
        if achieved is None or self._before is None:
            return self._external.wrench
        thrust = self._lag.step(dt, achieved.wrench)
        external = self._external.step(dt, self._before, now, thrust)
        self._health = self._watch(dt, self._external.unexplained)
        return external

    def _watch(self, dt: float, unexplained: Array) -> ThrusterHealth:
        """What the thrusters give, where it is known what they were told."""
        if self._allocation is None:
            return self._health
        return self._monitor.step(
            dt,
            unexplained,
            NOT_KNOWN,
            self._allocation.thrust,
            self._allocation.effectiveness,
        )

    def _accelerations(
        self, dt: float, odometry: Odometry, joints: JointStates
    ) -> tuple[Array, Array]:
        """Vehicle (6,), body frame, and joints (n,)."""
        measured = np.array((joints.position, joints.velocity))
        q_ddot = self._joints.step(dt, measured, self._encoder_variances)[2]
        a, b, c, d, e, f = odometry.twist_covariance.diagonal().tolist()
        linear, angular = np.array(((a + b + c) / 3.0,)), np.array(((d + e + f) / 3.0,))
        nu = odometry.nu.reshape(1, 6)
        nu_dot = np.empty(6)
        nu_dot[:3] = self._linear.step(dt, nu[:, :3], linear)[1]
        nu_dot[3:] = self._angular.step(dt, nu[:, 3:], angular)[1]
        return nu_dot, q_ddot

    def _check(self, odometry: Odometry, joints: JointStates, achieved: Wrench | None) -> None:
        if self._stamp is not None:
            checks.later("odometry.stamp", odometry.stamp, self._stamp, "the last one's")
        checks.age("joint_states", joints.stamp, odometry.stamp)
        checks.check("odometry", odometry)
        checks.check("joint_states", joints, n=self._joint_names)
        if achieved is not None:
            checks.check("wrench_achieved", achieved)


def _encoder_variances(vehicle: Vehicle) -> Array:
    """Variances (2,) of angle and rate; rounding to a step s adds s^2 / 12."""
    encoders = vehicle.sensors.encoders
    angle = encoders.noise_deg**2 + encoders.resolution_deg**2 / 12.0
    return np.radians(1.0) ** 2 * np.array([angle, encoders.rate_noise_deg_s**2])
