"""The arm swings to starboard under an uncontrolled vehicle, which rolls and comes to rest again.

Uses uvms_dynamics: the plant, its true state, and the mass matrix for the kinetic energy
1/2 zeta^T M(q) zeta with zeta = (nu, q_dot). Run it: python examples/dynamics_free_roll.py
"""

import numpy as np

from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, mass_matrix, quat_to_rpy
from uvms_dynamics.simulation import Plant, PlantConfig

STRETCHED, SWUNG = np.radians([0.0, 0.0, 0.0, 0.0]), np.radians([60.0, 0.0, 0.0, 0.0])
SWING_FROM, SWING_TO = 2.0, 10.0  # s
BANDWIDTH = 3.0  # rad/s

vehicle = load_vehicle()
model = build_model(vehicle)
plant = Plant(vehicle, PlantConfig(initial_joints_deg=(0.0, 0.0, 0.0, 0.0)), seed=1)
idle = np.zeros(vehicle.n_thrusters)

print("  time   swing    roll   pitch  kinetic energy  moment of weight and buoyancy")
print("     s     deg     deg     deg              mJ                            N m")
while plant.stamp <= 40_000_000_000:
    t, truth = 1e-9 * plant.stamp, plant.truth()
    q, q_dot = truth.joints.position, truth.joints.velocity
    if plant.stamp % 2_000_000_000 == 0:
        roll, pitch, _ = np.degrees(quat_to_rpy(truth.odometry.quaternion))
        zeta = np.concatenate([truth.odometry.nu, q_dot])
        energy = 0.5e3 * zeta @ mass_matrix(model, q) @ zeta
        moment = truth.disturbance.restoring[3]
        print(f"{t:6.1f}{np.degrees(q[0]):8.2f}{roll:8.2f}{pitch:8.2f}{energy:16.2f}{moment:31.3f}")
    # Computed torque: errors of angle and rate become an acceleration of the joint.
    u = np.clip((t - SWING_FROM) / (SWING_TO - SWING_FROM), 0.0, 1.0)
    target = STRETCHED + u**2 * (3 - 2 * u) * (SWUNG - STRETCHED)
    acceleration = BANDWIDTH**2 * (target - q) - 2.0 * BANDWIDTH * q_dot
    effort = mass_matrix(model, q)[6:, 6:] @ acceleration
    plant.step(ThrusterCommand(plant.stamp, idle), JointCommand(plant.stamp, effort))

print("\nThe vehicle comes to rest at a roll angle at which weight and buoyancy balance.")
