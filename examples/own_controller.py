"""A controller of your own in the loop, compared with the one that comes with UVMS.

Uses uvms_bringup and uvms_control. Any object with `step(odometry, joints, disturbance, reference)`
that returns (Wrench, JointCommand) will do. This one controls the vehicle by proportional and
derivative terms only, and leaves the joints to UVMS. Run it: python examples/own_controller.py
"""

import numpy as np

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_control import Controller, sample_reference, tracking_error
from uvms_core.signals import JointCommand, JointStates, Odometry, Reference, Wrench
from uvms_dynamics import quat_to_rpy


class PdController:
    """Wrench = K e + D e_dot in the body frame, axis by axis."""

    K = np.array([150.0, 300.0, 300.0, 15.0, 150.0, 150.0])  # N/m, N m/rad
    D = np.array([250.0, 450.0, 450.0, 8.0, 150.0, 150.0])  # N s/m, N m s/rad

    def __init__(self, arm: Controller) -> None:
        self.arm = arm

    def step(
        self,
        odometry: Odometry,
        joints: JointStates,
        disturbance: Wrench | None,
        reference: Reference,
    ) -> tuple[Wrench, JointCommand]:
        """The vehicle's wrench by this law, the joints' torques by that of UVMS."""
        _, torques = self.arm.step(odometry, joints, disturbance, reference)
        target = sample_reference(reference, odometry.stamp)
        found = tracking_error(odometry, target)
        return Wrench(odometry.stamp, self.K * found.error + self.D * found.rate), torques


def run(own: bool) -> np.ndarray:
    """Roll and pitch in degrees over the arm's swing, (k, 2)."""
    scenario = load_scenario("arm_swing")
    vehicle = scenario.load_vehicle()
    loop = Loop(scenario, vehicle)
    if own:
        loop.controller = PdController(loop.controller)
    angles = []
    while (tick := loop.tick()).stamp < 1e9 * scenario.duration_s:
        if tick.stamp == 0:
            loop.planner.accept(scenario.goal.build(vehicle, scenario.plant))
        angles.append(np.degrees(quat_to_rpy(tick.truth.odometry.quaternion)[:2]))
        loop.advance(tick)
    return np.array(angles)


if __name__ == "__main__":
    for own, name in ((False, "UVMS: S-surface, model, observer"), (True, "PD only")):
        roll, pitch = np.abs(run(own)).max(axis=0)
        print(f"{name:34s} greatest roll {roll:6.2f} deg, greatest pitch {pitch:6.2f} deg")
