"""The arm's added inertia about its swing and shoulder axes decreases as the elbow bends (Fig. 6).

Uses uvms_dynamics, and uvms_analysis for the style of the figure.
Run it: python examples/dynamics_added_inertia.py [--vehicle FILE] [--output FIGURE.png]
"""

import argparse

import numpy as np

from uvms_analysis.report import style
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.model.arm_inertia import arm_added_inertia

SWING, SHOULDER, ELBOW = 0, 1, 2

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--vehicle", help="vehicle file (default: the reference vehicle)")
parser.add_argument("--output", help="file of the figure (default: none)")
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

if options.output:
    with style.settings():
        figure = style.new_figure(height=3.2)
        axes = figure.subplots()
        axes.plot(
            elbow_deg, inertias[:, SWING], color=style.COLORS[0], label="about the swing axis"
        )
        axes.plot(
            elbow_deg, inertias[:, SHOULDER], color=style.COLORS[1], label="about the shoulder axis"
        )
        axes.set(xlabel="elbow angle / deg", ylabel="added inertia / kg m$^2$")
        axes.set(xlim=(0.0, 135.0), ylim=(0.0, None), xticks=elbow_deg[::3])
        axes.set_title("Added inertia of the arm")
        style.legend(axes)
        figure.savefig(options.output)
    print(f"figure: {options.output}")
