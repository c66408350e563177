"""Simulate over time: one run of ten seconds, then a hundred at once from different initial states.

Uses uvms_dynamics. Run it: python examples/dynamics_over_time.py
"""

import numpy as np

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import quat_to_rpy
from uvms_dynamics.simulation import advance_batch, make_state, make_system, simulate

STEP, STEPS = 0.005, 2000  # s; unlike the plant, `simulate` does not refuse an unstable step

vehicle = load_vehicle()
system = make_system(vehicle, current=(0.1, 0.0, 0.0))
n, m = vehicle.n_joints, vehicle.n_thrusters
start = make_state(np.radians([0.0, 0.0, 60.0, 0.0]), m, position=(0.0, 0.0, 10.0))
thrust, torque = np.zeros(m), np.array([0.6, 0.0, 0.0, 0.0])  # N, N m: the arm swings to starboard

states = simulate(system, start, thrust, torque, STEP, STEPS)  # (steps + 1, 13 + 2n + m)
print("  time   swing    roll   pitch")
for row in range(0, STEPS + 1, 400):
    roll, pitch, _ = np.degrees(quat_to_rpy(states[row, 3:7]))
    print(f"{row * STEP:6.1f}{np.degrees(states[row, 13]):8.2f}{roll:8.2f}{pitch:8.2f}")

count, rng = 100, np.random.default_rng(1)
starts = np.tile(start, (count, 1))
starts[:, 13 : 13 + n] += rng.uniform(-0.2, 0.2, (count, n))  # joint angles
ends = advance_batch(
    system, starts, np.tile(thrust, (count, 1)), np.tile(torque, (count, 1)), STEP, STEPS
)
rolls = np.degrees([quat_to_rpy(quat)[0] for quat in ends[:, 3:7]])
print(f"at the end, from {count} starts: roll {rolls.min():.2f} to {rolls.max():.2f} deg")
