"""The navigation filter and the disturbance observer on simulated sensors.

Uses uvms_observer on the samples of a plant that moves along a curve while its arm swings, and
prints errors of position and heading, and the observed and true roll moment.
Run it: python examples/observer_navigation.py
"""

import numpy as np

from uvms_core.signals import JointCommand, ThrusterCommand, Wrench
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import quat_to_rpy, thruster_matrix
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_observer import DisturbanceObserver, NavigationConfig, NavigationFilter, ObserverConfig

vehicle = load_vehicle()
plant = Plant(vehicle, PlantConfig(initial_rpy_deg=(0.0, 0.0, 30.0)), seed=4)
navigation = NavigationFilter(vehicle, NavigationConfig())
observer = DisturbanceObserver(vehicle, ObserverConfig())
B = thruster_matrix(vehicle)
achieved = None

print("  time  position error  expected (1 sigma)  heading error   roll moment, observed    true")
print("     s              cm                  cm            deg                     N m     N m")
while plant.stamp <= 60_000_000_000:
    t, frame, truth = 1e-9 * plant.stamp, plant.sense(), plant.truth()
    estimate = navigation.step(plant.stamp, frame.imu, frame.dvl, frame.pressure, frame.gps)
    budget, _ = observer.step(estimate, frame.joints, achieved)
    if plant.stamp and plant.stamp % 5_000_000_000 == 0:
        error = 100 * np.linalg.norm(estimate.position - truth.odometry.position)
        sigma = 100 * np.sqrt(np.trace(estimate.pose_covariance[:3, :3]))
        yaw, true_yaw = (quat_to_rpy(o.quaternion)[2] for o in (estimate, truth.odometry))
        observed, true = ((b.restoring + b.coupling)[3] for b in (budget, truth.disturbance))
        print(
            f"{t:6.1f}{error:16.2f}{sigma:20.2f}{np.degrees(yaw - true_yaw):15.3f}"
            f"{observed:24.3f}{true:8.3f}"
        )
    thrust = np.array([6.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0])
    effort = np.array([1.5 * np.sin(0.6 * t), 0.0, 0.0, 0.0])
    achieved = Wrench(plant.stamp, B @ thrust)
    plant.step(ThrusterCommand(plant.stamp, thrust), JointCommand(plant.stamp, effort))

status = navigation.status()
print("\nsamples taken:", {k: v for k, v in status.items() if k.endswith("_accepted")})
