"""The panel method against Lamb's closed form: how the error falls with the number of panels.

Uses uvms_dynamics with its extra `panels`. For a body of your own the command is `uvms added-mass`.
Run it: python examples/dynamics_added_mass.py
"""

import numpy as np

from uvms_dynamics.panel_method import estimate, in_frame, pose_of, shape_body

WATER = 1025.0
CENTRED = pose_of(about=np.zeros(3), rpy_deg=np.zeros(3))

print("error against Lamb, %: as solved / extrapolated from that and a quarter of the panels")
for shape in ("sphere:0.25", "spheroid:2.4,0.38", "ellipsoid:1,0.5,0.3"):
    print(f"\n{shape:19}" + "".join(f"{term:>15}" for term in "XYZKMN"))
    for panels in (250, 800, 1600):
        body = shape_body(shape, CENTRED, WATER, panels)
        found = estimate(body.levels, body.density)
        exact = np.diag(next(iter(body.rows.values())))
        count, solved = found.solved[-1]
        line = f"{count:12} panels"
        for term, value in enumerate(exact):
            if value == 0.0:
                line += f"{'no term':>15}"
                continue
            errors = [100 * (m[term, term] / value - 1) for m in (solved, found.matrix)]
            line += f"{errors[0]:+7.2f}/{errors[1]:+.2f}".rjust(15)
        print(line)

print("\nThe same ellipsoid about a point 1 m aft of its centre, by X^T M X (kg, kg m, kg m^2):")
print(np.round(in_frame(found.matrix, *pose_of(np.array([-1.0, 0.0, 0.0]), np.zeros(3))), 2) + 0.0)
