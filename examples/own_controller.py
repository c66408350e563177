"""A controller of your own in the loop, compared with the one that comes with UVMS.

Any class that fulfils `uvms_control.ControlLaw` will do. This one controls the vehicle by
proportional and derivative terms only, and leaves the joints to UVMS. Run it:
python examples/own_controller.py. The same on the command line, in this folder:
uvms simulate arm_swing --set control.law=own_controller:PdController
"""

import numpy as np

from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_control import ControlConfig, Controller, sample_reference, tracking_error
from uvms_core.signals import JointCommand, JointStates, Odometry, Reference, Wrench
from uvms_core.vehicle import Vehicle
from uvms_dynamics import quat_to_rpy


class PdController:
    """Wrench = K e + D e_dot in the body frame, axis by axis."""

    K = np.array([150.0, 300.0, 300.0, 15.0, 150.0, 150.0])  # N/m, N m/rad
    D = np.array([250.0, 450.0, 450.0, 8.0, 150.0, 150.0])  # N s/m, N m s/rad

    def __init__(self, vehicle: Vehicle, config: ControlConfig) -> None:
        self.arm = Controller(vehicle, config)

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


def run(law: str) -> np.ndarray:
    """Roll and pitch in degrees over the arm's swing, (k, 2)."""
    scenario = load_scenario("arm_swing", [f"control.law={law}"])
    vehicle = scenario.load_vehicle()
    goal = scenario.goal.build(vehicle, scenario.plant)
    angles: list[np.ndarray] = []
    simulate(
        scenario,
        vehicle,
        goal,
        observe=lambda tick: angles.append(quat_to_rpy(tick.truth.odometry.quaternion)[:2]),
    )
    return np.degrees(np.array(angles))


if __name__ == "__main__":
    for law, name in (
        ("default", "UVMS: model, observer, gains by rule"),
        ("own_controller:PdController", "PD only"),
    ):
        roll, pitch = np.abs(run(law)).max(axis=0)
        print(f"{name:34s} greatest roll {roll:6.2f} deg, greatest pitch {pitch:6.2f} deg")
