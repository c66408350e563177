"""A control law: proportional and derivative terms, and the weight in water of vehicle and arm."""

import numpy as np
from pydantic import Field

from uvms_control import ControlConfig, sample_reference, tracking_error
from uvms_core.config import Config
from uvms_core.signals import JointCommand, JointStates, Odometry, Reference, Wrench
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model, inverse_dynamics, mass_matrix, restoring_wrench


class MyLaw:
    """Wrench M (k e + d e_dot) less the restoring wrench, and the same for each joint.

    M is the whole system's mass matrix with added mass, so that the gains mean the bandwidth and
    the damping ratio of each axis, whatever the vehicle. What the arm's motion does to the vehicle
    is not fed forward, and the observed disturbance is not used.
    """

    class Parameters(Config):
        """Set by `control.parameters.NAME`; in the node by the ROS parameter `parameters.NAME`."""

        bandwidth: float = Field(1.2, gt=0.0, le=5.0, description="of the vehicle's axes, rad/s")
        arm_bandwidth: float = Field(6.0, gt=0.0, le=20.0, description="of the joints, rad/s")
        damping_ratio: float = Field(1.0, gt=0.0, le=5.0, description="of all axes, no unit")

    def __init__(self, vehicle: Vehicle, config: ControlConfig) -> None:
        self._model = build_model(vehicle)
        self._gains: MyLaw.Parameters = config.parameters
        self._limits = np.array([joint.effort_limit_nm for joint in vehicle.arm.joints])

    def step(
        self,
        odometry: Odometry,
        joints: JointStates,
        disturbance: Wrench | None,
        reference: Reference,
    ) -> tuple[Wrench, JointCommand]:
        """Wrench and joint torques for the tick at `odometry.stamp`."""
        wanted = sample_reference(reference, odometry.stamp)
        error = tracking_error(odometry, wanted)
        mass = mass_matrix(self._model, joints.position)
        feedback = self._feedback(self._gains.bandwidth, error.error, error.rate)
        weight = restoring_wrench(self._model, odometry.quaternion, joints.position)
        wrench = mass[:6, :6] @ feedback - weight

        pull = self._feedback(
            self._gains.arm_bandwidth, wanted.q - joints.position, wanted.q_dot - joints.velocity
        )
        torque = _arm_inertia(mass) @ pull + self._arm_weight(odometry, joints)
        return (
            Wrench(odometry.stamp, wrench),
            JointCommand(odometry.stamp, np.clip(torque, -self._limits, self._limits)),
        )

    def _feedback(self, bandwidth: float, error: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Acceleration that a critically damped (or other) second-order system would have."""
        return bandwidth**2 * error + 2.0 * self._gains.damping_ratio * bandwidth * rate

    def _arm_weight(self, odometry: Odometry, joints: JointStates) -> np.ndarray:
        """Torques (n,) N m that hold the arm against weight and buoyancy."""
        still, at_rest = np.zeros(6), np.zeros(len(joints.position))
        forces = inverse_dynamics(
            self._model, odometry.quaternion, still, still, joints.position, at_rest, at_rest
        )
        return forces[6:]


def _arm_inertia(mass: np.ndarray) -> np.ndarray:
    """Inertia (n, n) that the joints feel on a vehicle that is free to give way."""
    coupling = mass[:6, 6:]
    return mass[6:, 6:] - coupling.T @ np.linalg.solve(mass[:6, :6], coupling)
