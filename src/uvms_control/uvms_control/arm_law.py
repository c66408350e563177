"""The arm's share of the controller: from estimated state and reference to joint torques."""

import numpy as np

from uvms_control.arm_controller import ArmController, floating_inertia
from uvms_control.compensation import EndEffectorCompensation, JointCorrection
from uvms_control.config import ControlConfig
from uvms_control.reference import ReferenceSample
from uvms_control.vehicle_data import effort_limits
from uvms_core.signals import Array, DisturbanceBudget, JointStates, Odometry
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_dynamics import Model, inverse_dynamics, joint_passive_torque


class ArmLaw:
    """Joint torques by eq. (19), for a reference that makes up for the vehicle's own motion."""

    def __init__(self, vehicle: Vehicle, model: Model, config: ControlConfig):
        """`model`: kernel tables of `vehicle`, as `uvms_dynamics.build_model` makes them."""
        self._config = config
        self._model = model
        self._n = vehicle.n_joints
        lower, upper = joint_limits(vehicle)
        self._away_from_stops = 0.5 * (lower + upper)
        self.joints = ArmController(config.arm, effort_limits(vehicle))
        self.compensation = EndEffectorCompensation(model, config.compensation, lower, upper)

    def reset(self) -> None:
        """Return to the state before the first step."""
        self.joints.reset()
        self.compensation.reset()

    def inform(self, budget: DisturbanceBudget) -> None:
        """What the observer knows of the payload; called before `step`."""

    def step(
        self,
        odometry: Odometry,
        joints: JointStates,
        desired: ReferenceSample,
        mass: Array,
        nu_dot: Array,
        dt: float,
    ) -> Array:
        """Joint torques (n,) in N m within the drives' limits, held until the next step.

        Args:
            odometry: estimated pose and velocity of the vehicle.
            joints: encoders.
            desired: reference at the stamp of `odometry`.
            mass: M(q) (6 + n, 6 + n) of the whole system.
            nu_dot: reference acceleration (6,) of the vehicle in its body frame; zeros where it is
                not controlled.
            dt: time since the last step, s; 0 at the first.
        """
        feed_forward = self._model_torque(odometry, joints, desired, nu_dot)
        correction = self._correction(odometry, desired, dt)
        q_dot = desired.q_dot + correction.rate
        error = desired.q + correction.angle - joints.position
        steered = self.joints.steered_rate(error, q_dot, dt)
        friction = joint_passive_torque(self._model, self._away_from_stops, steered)
        load = feed_forward - self._config.arm.friction_compensation * friction
        rate = q_dot - joints.velocity
        return self.joints.effort(error, rate, floating_inertia(mass), load, dt)

    def _correction(
        self, odometry: Odometry, desired: ReferenceSample, dt: float
    ) -> JointCorrection:
        if self._config.enabled and self._config.compensate_vehicle_motion:
            return self.compensation.step(odometry, desired, dt)
        return JointCorrection(np.zeros(self._n), np.zeros(self._n))

    def _model_torque(
        self, odometry: Odometry, joints: JointStates, desired: ReferenceSample, nu_dot: Array
    ) -> Array:
        """K Delta-u of eq. (19): what the model needs for the reference acceleration (n,) N m.

        Weight, buoyancy, drag and the vehicle's reference acceleration are in it, friction is not.
        The vehicle's feedback acceleration is left out: what it really causes is uncertain when a
        disturbance is not fed forward or a thruster saturates.
        """
        whole = inverse_dynamics(
            self._model,
            odometry.quaternion,
            odometry.nu,
            nu_dot,
            joints.position,
            joints.velocity,
            desired.q_ddot,
        )
        return whole[6:]
