"""The dynamics of one's own chain: a hull and two links in the water, as plain data, without ROS.

Words such as `cylinder` stand for what follows from a shape; what is not said is as in the
reference vehicle. Run it: python examples/dynamics_own_chain.py
"""

import numpy as np

from uvms_dynamics import build_model, forward_dynamics, inverse_dynamics, load_vehicle, mass_matrix

FROM_SHAPE = ("volume_m3", "cg_m", "cb_m", "inertia_kg_m2", "added_mass", "drag")


def link(name, mass, radius, length):
    """A homogeneous cylinder from joint to joint, along x of its frame."""
    centre = [-0.5 * length, 0.0, 0.0]
    shape = {"center_m": centre, "axis": [1, 0, 0], "radius_m": radius, "length_m": length}
    return {
        "name": name,
        "mass_kg": mass,
        "cylinder": shape,
        **dict.fromkeys(FROM_SHAPE, "cylinder"),
    }


joint = load_vehicle().arm.joints[1].model_dump()
vehicle = load_vehicle(
    overrides={
        "hull.spheroid": {"length_m": 1.2, "diameter_m": 0.4},
        "arm.base": {"position_m": [0.4, 0.0, 0.2], "rpy_deg": [90.0, 0.0, 0.0]},
        "arm.joints": [joint | {"name": "one", "a_m": 0.5}, joint | {"name": "two", "a_m": 0.4}],
        "arm.links": [link("upper", 3.0, 0.04, 0.5), link("lower", 2.0, 0.035, 0.4)],
        "arm.stowed_deg": [0.0, 90.0],
    }
)
model = build_model(vehicle)
level, nu, tau = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6), np.zeros(8)
q, q_dot = np.radians([30.0, 45.0]), np.array([0.2, -0.1])
tau[6:] = 3.0, 1.0  # N m on the joints; no thrust

acceleration = forward_dynamics(model, level, nu, q, q_dot, tau)
needed = inverse_dynamics(model, level, nu, acceleration[:6], q, q_dot, acceleration[6:])

np.set_printoptions(formatter={"float": "{:.3f}".format}, linewidth=100)
print(f"acceleration of the vehicle, m/s^2 and rad/s^2: {acceleration[:6]}")
print(f"acceleration of the joints, rad/s^2:            {acceleration[6:]}")
print(f"wrench and torques that this needs, N and N m:  {needed}")
print(f"diagonal of the mass matrix, kg and kg m^2:     {mass_matrix(model, q).diagonal()}")
