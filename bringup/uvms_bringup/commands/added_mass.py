"""The command `uvms added-mass`: the added mass of a body, ready for the vehicle file."""

import math
from argparse import ArgumentParser, ArgumentTypeError, Namespace, RawDescriptionHelpFormatter

from uvms_core.command import Command

DESCRIPTION = """\
6x6 added mass of a hull or link in unbounded water, by the panel method (capytaine).
BODY is one of
  a mesh file (.stl .obj .ply .off .glb .gdf ...): one closed surface in metres, normals outwards
  a shape, its length along x, in metres: {shapes}
  with --vehicle FILE: hull, or the name of a link, where the file has a shape for it
The output is YAML: the entry `added_mass` of the vehicle file, with comments on how sure it is."""
EXAMPLES = """examples:
  uvms added-mass spheroid:2.4,0.38
  uvms added-mass hull.stl --scale 0.001 --rpy 180,0,0 > added_mass.yaml    mm, z upwards
  uvms added-mass link.obj --about=-0.23,0,0 --density 1000
  uvms added-mass forearm --vehicle my_auv.yaml

More: docs/added-mass.md"""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms added-mass`."""
    from uvms_dynamics.panel_method.bodies import MOST_HALVED, PANELS, SEA_WATER
    from uvms_dynamics.panel_method.solids import WORDS

    shapes = "  ".join(f"{word}:{sizes}" for word, sizes in WORDS.items())
    parser.description = DESCRIPTION.format(shapes=shapes)
    parser.epilog = EXAMPLES
    parser.formatter_class = RawDescriptionHelpFormatter
    add = parser.add_argument
    add("body", metavar="BODY", help="mesh file, shape:SIZES, or part of --vehicle")
    add("--vehicle", metavar="FILE", help="name or file of a vehicle whose hull or link BODY names")
    add("--scale", type=float, metavar="M", help="unit of the mesh file in metres (mm: 0.001)")
    add("--flip", action="store_true", help="turn the mesh's normals round")
    add(
        "--about",
        type=_vector,
        metavar="X,Y,Z",
        help="origin of the body frame in the file's frame, m, after scaling (default 0,0,0);"
        " write --about=-0.1,0,0 where the first is negative",
    )
    add(
        "--rpy",
        type=_vector,
        metavar="R,P,Y",
        help="attitude of the file's axes in the body frame, degrees (default 0,0,0; 180,0,0 turns"
        " forward-port-up into forward-starboard-down)",
    )
    add(
        "--density",
        type=float,
        metavar="RHO",
        help=f"of the water, kg/m^3 (default: the vehicle's, or {SEA_WATER:g})",
    )
    add(
        "--panels",
        type=int,
        default=PANELS,
        metavar="N",
        help=f"of the finest surface (default {PANELS}; a mesh file that has more than a quarter"
        f" of it is halved up to {MOST_HALVED}, or to N if that is more)",
    )


def run(options: Namespace) -> int:
    """Solve for the added mass and print it as YAML."""
    from uvms_bringup.added_mass import added_mass

    return added_mass(options)


def _vector(text: str) -> tuple[float, ...]:
    try:
        numbers = tuple(float(part) for part in text.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise ArgumentTypeError(f"{text!r} must be three numbers, as in 0.1,0,0")
    return numbers


COMMAND = Command("added mass of a mesh or shape, ready for the vehicle file", add_arguments, run)
