"""The self-disturbance observers: what acts on the vehicle besides its thrusters."""

import warnings

import numpy as np

from uvms_core import checks
from uvms_core.signals import (
    Allocation,
    Array,
    DisturbanceBudget,
    JointStates,
    Odometry,
    Payload,
    ThrusterHealth,
    Wrench,
    to_seconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model, build_model, thruster_matrix
from uvms_dynamics.external_bandwidth import external_bandwidth
from uvms_dynamics.joint_filter import JointEstimate
from uvms_dynamics.joint_prediction import JointPrediction, encoder_variances
from uvms_dynamics.kernels.ambient import water_wrenches
from uvms_dynamics.payload import COLUMNS, LoadedModel
from uvms_dynamics.sensor_noise import sensor_noise
from uvms_observer.disturbance.external import (
    NU,
    POSE,
    follow_external,
    momentum_noise,
    unexplained_force,
)
from uvms_observer.disturbance.model_parts import ModelParts
from uvms_observer.disturbance.observer_config import ObserverConfig
from uvms_observer.disturbance.thrust_lag import ThrustLag
from uvms_observer.health import Handover, ThrusterMonitor
from uvms_observer.payload import PayloadEstimator
from uvms_observer.payload.fit import theta_of

NOT_KNOWN = np.zeros(6)
"""Std of the unexplained wrench of one interval: the monitor works it out from the wrench."""
FORMER_BANDWIDTH_RAD_S = 0.5
"""Of the observer that was called momentum_residual."""


class ModelObserver:
    """Observer `paper`, eq. (21) alone: restoring and coupling wrench of the estimated state.

    F_dis = restoring(R, q) + coupling(nu, nu_dot, q, q_dot, q_ddot), a wrench that acts ON the
    vehicle, body frame, about its origin. Accelerations come from tracking filters; joint states
    that are late are carried to the odometry's stamp. Nothing is external.

    Args:
        vehicle: model, encoder noise, thruster lag.
        config: bandwidths and limits.
    """

    def __init__(self, vehicle: Vehicle, config: ObserverConfig) -> None:
        self._vehicle, self._config = vehicle, config
        self._model: Model = build_model(vehicle)
        self._loaded = LoadedModel(self._model)
        self._joint_names = vehicle.joint_names
        self._joints = JointPrediction(vehicle, config.joint_jerk_rad_s3, config.joint_age_limit_s)
        noise = sensor_noise(vehicle)[1].reshape(2, 3).max(axis=1)
        self._parts = ModelParts(noise, (config.vehicle_jerk_m_s3, config.vehicle_jerk_rad_s3))
        self._stamp: int | None = None

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
        dt = 0.0 if self._stamp is None else to_seconds(odometry.stamp - self._stamp)
        motion = self._joints.step(joints, odometry.stamp)
        external, sigma = self._observe(dt, odometry, motion, joints.effort, achieved)
        self._stamp = odometry.stamp
        restoring, coupling, held = self._parts.step(self._loaded.model, dt, odometry, motion)
        total = restoring + held
        if self._config.external:
            total += external
        budget = DisturbanceBudget(
            odometry.stamp, restoring, coupling, external, sigma, self._payload(), self._thrusters()
        )
        return budget, Wrench(odometry.stamp, total)

    def _observe(
        self,
        dt: float,
        odometry: Odometry,
        motion: JointEstimate,
        effort: Array,
        achieved: Wrench | None,
    ) -> tuple[Array, Array]:
        """The external wrench (6,) and its standard deviation (6,), 0: not known."""
        return np.zeros(6), np.zeros(6)

    def _payload(self) -> Payload | None:
        return None

    def _thrusters(self) -> ThrusterHealth | None:
        return None

    def _check(self, odometry: Odometry, joints: JointStates, achieved: Wrench | None) -> None:
        if self._stamp is not None:
            checks.later("odometry.stamp", odometry.stamp, self._stamp, "the last one's")
        self._joints.check(joints, odometry.stamp)
        checks.check("odometry", odometry)
        checks.check("joint_states", joints, n=self._joint_names)
        if achieved is not None:
            checks.check("wrench_achieved", achieved)


class DisturbanceObserver(ModelObserver):
    """Observer `momentum`: as `paper`, and the remainder as external wrench.

    The remainder is a momentum residual, with the bandwidth of the configuration or by rule. The
    water is assumed at rest: the effect of a current is part of the external wrench.
    """

    def __init__(self, vehicle: Vehicle, config: ObserverConfig) -> None:
        super().__init__(vehicle, config)
        self._lag = ThrustLag(vehicle)
        self._rate_variance = float(encoder_variances(vehicle)[1])
        self._before: Array | None = None
        self._feels = False
        """Whether the drives report torques; without, the joints' rows mean nothing."""
        self._filter = np.zeros((6, 1 + COLUMNS))
        self._theta = np.zeros(COLUMNS)  # of the payload in the loaded model
        self._external, self._sigma = np.zeros(6), np.zeros(6)
        self._dt, self._gain, self._spread = 0.0, np.zeros(6), np.zeros(6)
        self._bandwidth = np.empty(0)  # before `prepare`

    def prepare(self, period: float) -> None:
        """Work out the bandwidth for a control period in s; else the first interval decides."""
        given = self._config.external_bandwidth_rad_s
        self._bandwidth = self._rule(period) if given is None else np.full(6, given)

    def _rule(self, period: float) -> Array:
        return external_bandwidth(self._vehicle, period)

    def _observe(
        self,
        dt: float,
        odometry: Odometry,
        motion: JointEstimate,
        effort: Array,
        achieved: Wrench | None,
    ) -> tuple[Array, Array]:
        now = np.concatenate((odometry.quaternion, odometry.nu, motion.q, motion.q_dot))
        before, self._before = self._before, now
        if achieved is None or before is None:
            return self._external.copy(), self._sigma
        if dt != self._dt:
            self._set_interval(dt)
        self._feels = bool(effort.any())
        thrust = self._lag.step(dt, achieved.wrench)
        smooth = self._parts.nu_dot, motion.q_ddot
        force, forces = unexplained_force(self._model, dt, before, now, thrust, effort, smooth)
        noise = momentum_noise(self._model, now, odometry.twist_covariance, self._rate_variance)
        self._explain(dt, now, force, forces, noise)
        self._external = follow_external(self._filter, self._gain, force, forces, self._theta)
        self._sigma = self._spread * np.sqrt(noise[:6])
        return self._external.copy(), self._sigma

    def _explain(self, dt: float, now: Array, force: Array, forces: Array, noise: Array) -> None:
        """Look for what may explain the unexplained force of the interval.

        Args:
            dt: its length, s.
            now: moment (10 + 2 n,) at its end, as of `external`.
            force: (6+n,) what the motion needs beyond model (without payload) and drives; what a
                part of the system explains may be taken off in place.
            forces: (6+n, 8) a payload's, as of `payload_forces`.
            noise: (6+n,) variances of the momentum, (N s)^2.
        """

    def _set_interval(self, dt: float) -> None:
        """Gain, and std of the estimate over that of the momentum, at intervals of dt s."""
        if not self._bandwidth.size:
            self.prepare(dt)
        self._dt = dt
        self._gain = -np.expm1(-self._bandwidth * dt)
        self._spread = self._gain / dt * np.sqrt(2.0 / (2.0 - self._gain))


class CombinedObserver(DisturbanceObserver):
    """Observer `combined`: as `momentum`, and what the gripper holds and the thrusters lose.

    A payload that is confirmed is taken into the model, so that its forces are where they belong:
    in restoring and coupling at the posture of the arm, and no more in the external wrench.
    """

    def __init__(self, vehicle: Vehicle, config: ObserverConfig) -> None:
        super().__init__(vehicle, config)
        self._estimator = PayloadEstimator(vehicle)
        self._monitor = ThrusterMonitor(vehicle)
        self._handover = Handover(thruster_matrix(vehicle))
        self._allocation: Allocation | None = None

    def inform(self, allocation: Allocation | None) -> None:
        """Thrusts of the tick before, one by one, and the shares that they were counted with."""
        self._allocation = allocation

    def _explain(self, dt: float, now: Array, force: Array, forces: Array, noise: Array) -> None:
        if (told := self._allocation) is not None:
            wrench = force[:6] - forces[:6] @ self._theta
            q, q_dot = np.split(now[NU:], 2)
            water = water_wrenches(self._model, now[:POSE], now[POSE:NU], q, q_dot)
            self._monitor.step(dt, wrench, NOT_KNOWN, told.thrust, told.effectiveness, water)
            self._hand_over(force, told.effectiveness)
        if not (self._feels and self._estimator.step(dt, force, forces, noise)):
            return
        payload = self._estimator.payload
        if self._loaded.take(payload):
            self._theta = theta_of(np.array([payload.weight, *payload.position, payload.mass]))

    def _hand_over(self, force: Array, counted: Array) -> None:
        """Take what a new fault explains off the force of the interval (in place) and the filter.

        counted (m,): shares with which the thrusters were counted.
        """
        if (fault := self._monitor.found) is not None:
            self._filter[:, 0] += self._handover.remembered(fault, self._gain, counted)
        explained = self._handover.of_interval(self._monitor.lagged, counted)
        if explained is not None:
            force[:6] += explained

    def _payload(self) -> Payload:
        return self._estimator.payload

    def _thrusters(self) -> ThrusterHealth:
        return self._monitor.health


class FormerObserver(DisturbanceObserver):
    """Observer `momentum_residual`, as `momentum` was called: at 0.5 rad/s unless one is given."""

    def __init__(self, vehicle: Vehicle, config: ObserverConfig) -> None:
        warnings.warn(
            "observer.law momentum_residual is now called momentum, with a bandwidth by rule;"
            f" external_bandwidth_rad_s: {FORMER_BANDWIDTH_RAD_S:g} gives the former one",
            DeprecationWarning,
            stacklevel=2,
        )
        super().__init__(vehicle, config)

    def _rule(self, period: float) -> Array:
        return np.full(6, FORMER_BANDWIDTH_RAD_S)
