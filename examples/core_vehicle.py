"""Read a vehicle file with a change of its own, list its parts, and make a URDF of it.

Uses uvms_core alone, which holds the vehicle file and what follows from it without dynamics.
Run it: python examples/core_vehicle.py
"""

from xml.etree import ElementTree

import numpy as np

from uvms_core.description import urdf_text
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.locate import known_vehicles

print("vehicles that come with the project:", ", ".join(known_vehicles()))
vehicle = load_vehicle("reference_auv", {"hull.mass_kg": 190.0, "arm.links.3.mass_kg": 0.8})

print(f"\n{'part':12}{'mass, kg':>10}{'volume, l':>11}  centre of mass, m")
for name, part in [("hull", vehicle.hull), *((link.name, link) for link in vehicle.arm.links)]:
    centre = np.round(part.cg_m, 3)
    print(f"{name:12}{part.mass_kg:10.2f}{1000.0 * part.volume_m3:11.2f}  {centre}")
for joint in vehicle.arm.joints:
    limits = f"{joint.lower_deg:g} to {joint.upper_deg:g} deg"
    print(f"joint {joint.name}: {limits}, at most {joint.effort_limit_nm:g} N m")

urdf = ElementTree.fromstring(urdf_text(vehicle))
links, joints = urdf.findall("link"), urdf.findall("joint")
moving = [joint.get("name") for joint in joints if joint.get("type") == "revolute"]
print(f"\nURDF of {urdf.get('name')}: {len(links)} links, {len(joints)} joints")
print("of these move:", ", ".join(moving))
