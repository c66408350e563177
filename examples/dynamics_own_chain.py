"""The dynamics of your own vehicle and arm: a hull and two links in the water, from plain data.

Uses uvms_dynamics. Buoyancy, inertia, added mass and drag of the arm follow from the shapes;
thrusters, sensors, water and drives are those of the reference vehicle.
Run it: python examples/dynamics_own_chain.py
"""

import numpy as np

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, forward_dynamics, inverse_dynamics, mass_matrix

joint = load_vehicle().arm.joints[1].model_dump()
upper = {"center_m": [-0.25, 0, 0], "axis": [1, 0, 0], "radius_m": 0.04, "length_m": 0.5}
lower = {"center_m": [-0.2, 0, 0], "axis": [1, 0, 0], "radius_m": 0.035, "length_m": 0.4}
vehicle = load_vehicle(
    overrides={
        "name": "own_auv",
        "hull.spheroid": {"length_m": 1.2, "diameter_m": 0.4},
        "hull.linear_damping": [8.0, 15.0, 15.0, 0.5, 2.0, 2.0],  # does not follow from a shape
        "hull.quadratic_damping": [25.0, 120.0, 120.0, 0.5, 8.0, 8.0],
        "hull.fins": [],  # those of the reference vehicle would not fit
        "arm.base": {"position_m": [0.4, 0.0, 0.2], "rpy_deg": [90.0, 0.0, 0.0]},
        "arm.joints": [joint | {"name": "one", "a_m": 0.5}, joint | {"name": "two", "a_m": 0.4}],
        "arm.links": [
            {"name": "upper", "mass_kg": 3.0, "cylinder": upper},
            {"name": "lower", "mass_kg": 2.0, "cylinder": lower},
        ],
        "arm.stowed_deg": [0.0, 90.0],
        "arm.postures_deg": {},
    }
)
model = build_model(vehicle)
level, nu, q, q_dot = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6), np.array([0.5, 0.8]), np.zeros(2)
torques = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 1.0])  # no thrust, N m on the joints
acceleration = forward_dynamics(model, level, nu, q, q_dot, torques)
needed = inverse_dynamics(model, level, nu, acceleration[:6], q, q_dot, acceleration[6:])

np.set_printoptions(formatter={"float": "{:.3f}".format}, linewidth=100)
print(f"acceleration of the vehicle, m/s^2 and rad/s^2: {acceleration[:6]}")
print(f"acceleration of the joints, rad/s^2:            {acceleration[6:]}")
print(f"wrench and torques that this takes, N and N m:  {needed}")
print(f"diagonal of the mass matrix, kg and kg m^2:     {mass_matrix(model, q).diagonal()}")
