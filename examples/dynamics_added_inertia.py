"""The arm's added inertia about its swing and shoulder axes decreases as the elbow bends (Fig. 6).

Uses uvms_dynamics; `make figures` draws it.
Run it: python examples/dynamics_added_inertia.py [--vehicle FILE]
"""

import argparse

import numpy as np

from uvms_core.vehicle import load_vehicle
from uvms_dynamics.model.arm_inertia import arm_added_inertia

SWING, SHOULDER, ELBOW = 0, 1, 2

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--vehicle", help="vehicle file (default: the reference vehicle)")
options = parser.parse_args()

vehicle = load_vehicle(options.vehicle)
elbow_deg = np.linspace(0.0, 135.0, 28)
q = np.zeros((len(elbow_deg), vehicle.n_joints))
q[:, ELBOW] = np.radians(elbow_deg)
inertias = np.array([np.diag(arm_added_inertia(vehicle, angles)) for angles in q])

print("elbow   about swing   about shoulder")
print("  deg        kg m^2           kg m^2")
for angle, inertia in zip(elbow_deg[::3], inertias[::3], strict=True):
    print(f"{angle:5.0f}{inertia[SWING]:14.3f}{inertia[SHOULDER]:17.3f}")
