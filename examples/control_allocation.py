"""Thrusts for a wrench, within the thrusters' limits and beyond them.

Uses uvms_control: priorities in levels. If a wrench cannot be reached, the axes of the last levels
give way first; `preserve_direction` scales the whole wrench instead.
Run it: python examples/control_allocation.py
"""

import numpy as np

from uvms_control import AllocatorConfig, ThrustAllocator
from uvms_core.signals import Wrench
from uvms_core.vehicle import load_vehicle

WRENCHES = {
    "within all limits": [10.0, 5.0, -8.0, 1.0, -3.0, 2.0],
    "the main thruster's limit": [98.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    "more surge than available": [150.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    "too much heave and roll at once": [0.0, 0.0, 190.0, 8.0, 0.0, 0.0],
}
vehicle = load_vehicle()
np.set_printoptions(precision=1, suppress=True, floatmode="fixed", linewidth=110)
print(
    "thrusters:",
    ", ".join(f"{t.name} {t.astern_n:g} to {t.ahead_n:g} N" for t in vehicle.thrusters),
)

for preserve in (False, True):
    allocator = ThrustAllocator(
        vehicle, AllocatorConfig(preserve_direction=preserve, lag_compensation=0.0)
    )
    print(f"\npreserve_direction = {preserve}")
    for tick, (text, wrench) in enumerate(WRENCHES.items()):
        _, found = allocator.step(Wrench((tick + 1) * 1_000_000_000, np.array(wrench)))
        print(f"  {text}: {np.array(wrench)}")
        print(f"    thrust   {found.thrust}  at a limit: {int(found.saturated.sum())}")
        print(f"    achieved {found.achieved}  missing {found.residual}")
