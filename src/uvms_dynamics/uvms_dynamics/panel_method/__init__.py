"""Added mass of hulls and links in unbounded fluid by the panel method (extra `panels`)."""

from uvms_dynamics.panel_method.bodies import Body, mesh_body, pose_of, shape_body, vehicle_body
from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.estimate import AddedMassEstimate, estimate
from uvms_dynamics.panel_method.files import load_panels
from uvms_dynamics.panel_method.panels import Panels
from uvms_dynamics.panel_method.rows import added_mass_yaml
from uvms_dynamics.panel_method.solids import Box, Cylinder, Ellipsoid, Solid, parse_solid
from uvms_dynamics.panel_method.solver import solve
from uvms_dynamics.panel_method.theory import (
    ellipsoid_added_mass,
    in_frame,
    slender_cylinder_added_mass,
)

__all__ = [
    "AddedMassEstimate",
    "Body",
    "Box",
    "Cylinder",
    "Ellipsoid",
    "PanelMethodError",
    "Panels",
    "Solid",
    "added_mass_yaml",
    "ellipsoid_added_mass",
    "estimate",
    "in_frame",
    "load_panels",
    "mesh_body",
    "parse_solid",
    "pose_of",
    "shape_body",
    "slender_cylinder_added_mass",
    "solve",
    "vehicle_body",
]
