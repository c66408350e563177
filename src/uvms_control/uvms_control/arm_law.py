"""The arm's share of the controller: from estimated state and reference to joint torques."""

import numpy as np

from uvms_control.arm_controller import ArmController, JointAim
from uvms_control.arm_gains import arm_gains
from uvms_control.compensation import EndEffectorCompensation, JointCorrection
from uvms_control.config import ControlConfig
from uvms_control.reference import ReferenceSample
from uvms_control.vehicle_data import effort_limits, least_moment
from uvms_core import checks
from uvms_core.signals import Array, JointStates, Odometry, Payload
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_dynamics import inverse_dynamics, mass_matrix
from uvms_dynamics.joint_filter import JointFilter, JointProcess
from uvms_dynamics.joint_prediction import encoder_variances, joint_age_limit, loop_delay
from uvms_dynamics.payload import LoadedModel

Motion = tuple[Array, Array, Array]
"""Attitude (4,), nu (6,) and reference nu_dot (6,) of the vehicle."""
LEVEL: Motion = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6), np.zeros(6)
"""What is assumed where nobody knows: level, at rest."""
PERIOD_S = 0.05
"""Control period that gains are made for until `prepare` or two ticks tell the real one."""


class ArmLaw:
    """Joint torques by eq. (19), for a reference that makes up for the vehicle's own motion."""

    def __init__(self, vehicle: Vehicle, loaded: LoadedModel, config: ControlConfig):
        """`loaded`: model of `vehicle` with what it holds, shared with the vehicle's law."""
        self._vehicle, self._config, self._loaded = vehicle, config, loaded
        model = loaded.model
        self._n = vehicle.n_joints
        effort, load = effort_limits(vehicle), config.arm.load_limit
        self.joints = ArmController(effort, config.arm.amplitude, config.arm.friction_compensation)
        self.observer = JointFilter(model, load * effort, encoder_variances(vehicle))
        self.compensation = EndEffectorCompensation(
            model, config.compensation, *joint_limits(vehicle), least_moment(vehicle)
        )
        self.prepare(PERIOD_S)
        self._is_prepared = False
        self.reset()

    def prepare(self, period: float) -> None:
        """Work out the gains for a control period in s; what has been learnt stays."""
        self._is_prepared = True
        self._age_limit = joint_age_limit(self._vehicle, period)
        gains = arm_gains(self._vehicle, period, self._config.arm)
        self.joints.gains = gains
        surprise = self.joints.effort_limit / gains.inertia
        self.observer.process = JointProcess(gains.drift, gains.shake, surprise)
        self.compensation.fastest = 0.5 * float(gains.bandwidth.min())
        self.compensation.hull = 1.0 / (3.0 * loop_delay(self._vehicle, period))

    def reset(self) -> None:
        """Return to the state before the first step."""
        self._nu_dot = np.zeros(6)  # of the last step
        self.let_go()
        self.compensation.reset()

    def let_go(self) -> None:
        """The torques end: what was commanded last says nothing of how the joints move on."""
        self._motion: Motion | None = None  # that the last torque was for
        self._is_held = False
        self.observer.reset()

    def check(self, joints: JointStates, tick: int) -> None:
        """SignalError where the joint state is later than the tick, ns, or too old for it."""
        checks.age("joint_states", joints.stamp, tick, self._age_limit)

    def observe(self, joints: JointStates, tick: int) -> tuple[Array, Array]:
        """Angles and rates (n,) at the tick, ns, by encoders, torques and model."""
        now = self.observer.step(joints, tick)
        return now[0], now[1]

    def take(self, payload: Payload | None, odometry: Odometry) -> None:
        """Let the shared model have this payload where it is confirmed, or let it go again.

        `observe` comes before. What the model now explains is no longer an unknown load, so that
        the torque has no step.
        """
        if not self._loaded.would_take(payload):
            return
        motion = odometry.quaternion, odometry.nu, self._nu_dot
        before = self._holding_torque(motion)
        self._loaded.take(payload)
        self.observer.shift_load(self._holding_torque(motion) - before)

    def step(
        self,
        odometry: Odometry,
        desired: ReferenceSample,
        mass: Array,
        nu_dot: Array,
        dt: float,
        held: Odometry | None = None,
    ) -> Array:
        """Joint torques (n,) in N m within the drives' limits, held until the next step.

        `observe` comes before.

        Args:
            odometry: estimated pose and velocity of the vehicle.
            desired: reference at the stamp of `odometry`.
            mass: M(q) (6 + n, 6 + n) of the whole system.
            nu_dot: reference acceleration (6,) of the vehicle in its body frame; zeros where it is
                not controlled.
            dt: time since the last step, s; 0 at the first.
            held: pose and velocity that the arm makes up for, without errors that nothing ends
                (`as_if_held`); None: those of `odometry`.
        """
        if dt > 0.0 and not self._is_prepared:
            self.prepare(dt)
        motion = odometry.quaternion, odometry.nu, nu_dot
        self._nu_dot = nu_dot
        self._change_over(motion, is_held=False)
        correction = self._correction(held or odometry, desired, mass, dt)
        aim = JointAim(
            desired.q + correction.angle,
            desired.q_dot + correction.rate,
            desired.q_ddot + correction.acceleration,
        )
        return self._torque(odometry.stamp, motion, mass, aim)

    def hold(self, tick: int, posture: Array) -> Array:
        """Joint torques (n,) in N m that keep a posture (n,) rad, the vehicle level and at rest.

        `observe` comes before. Held from the tick, ns, until the next.
        """
        self._change_over(LEVEL, is_held=True)
        rest = np.zeros(self._n)
        mass = mass_matrix(self._loaded.model, self.observer.now[0])
        return self._torque(tick, LEVEL, mass, JointAim(posture, rest, rest))

    def _torque(self, tick: int, motion: Motion, mass: Array, aim: JointAim) -> Array:
        effort, drive = self.joints.step(self._loaded.model, motion, mass, self.observer.now, aim)
        self.observer.command(tick, drive)
        return effort

    def _change_over(self, motion: Motion, is_held: bool) -> None:
        """Between the estimated motion and the assumed one the torque has no step.

        What the one explains and the other does not is a load until the observer knows better.
        """
        before, self._motion = self._motion, motion
        if is_held != self._is_held and before is not None:
            self.observer.shift_load(self._holding_torque(motion) - self._holding_torque(before))
        self._is_held = is_held

    def _correction(
        self, odometry: Odometry, desired: ReferenceSample, mass: Array, dt: float
    ) -> JointCorrection:
        if self._config.enabled and self._config.compensate_vehicle_motion:
            return self.compensation.step(odometry, desired, mass, dt)
        return JointCorrection(np.zeros(self._n), np.zeros(self._n), np.zeros(self._n))

    def _holding_torque(self, motion: Motion) -> Array:
        q, q_dot, _ = self.observer.now
        torque: Array = inverse_dynamics(self._loaded.model, *motion, q, q_dot, np.zeros(self._n))[
            6:
        ]
        return torque
