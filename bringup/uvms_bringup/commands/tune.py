"""The command `uvms tune`: the gains that follow from a vehicle file, and what limits them."""

from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter

from uvms_core.command import Command

DESCRIPTION = """\
Print the gains of the vehicle's control law for a vehicle file, and why they are not larger. They
are worked out from the file and the control period alone; no run is needed, and nothing is written.
A run uses the same gains."""
EPILOG = """examples:
  uvms tune reference_auv
  uvms tune my_auv.yaml --control-period 0.02
  uvms tune bluerov2_alpha5 --posture home --set thrusters.0.time_constant_s=0.2
  uvms tune my_auv.yaml --set control.gains.noise_share=0.02
  uvms tune my_auv.yaml --json | jq .axes.roll

what is printed for each axis:
  inertia       of vehicle, arm and the water that moves with them, kg or kg m^2
  righting      moment of weight and buoyancy for one radian of tilt, N m/rad
  authority     greatest force or moment along the axis, N or N m
  lag           time constant of the slowest thruster that acts on it, s
  bandwidth     natural frequency of the feedback, rad/s
  damping       least damping ratio of the whole loop: hull, thrusters and feedback
  observer      bandwidth of the external wrench that is fed forward, rad/s
  delay margin  further delay that the loop bears before it becomes unstable, s
  gain margin   factor on the thrusters' force that it bears
  noise         share of the authority that follows sensor noise, rms
  full at       error at which the feedback alone would ask for the whole authority, m or rad
  limited by    what would not be kept with a larger bandwidth

Axes without authority are left to the hull. Exit code: 0, or 2 where something is not right."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms tune`."""
    parser.description, parser.epilog = DESCRIPTION, EPILOG
    parser.formatter_class = RawDescriptionHelpFormatter
    add = parser.add_argument
    add("vehicle", metavar="VEHICLE", help="vehicle file, or the name of one of the project's")
    add("--control-period", type=float, metavar="S", help="period of the control loop, s")
    add(
        "--posture",
        metavar="NAME",
        help="posture of the arm; by default all of the vehicle file, and the one that allows"
        " least decides",
    )
    add(
        "--set",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="change a value of the vehicle file (hull.mass_kg=190), or of the control"
        " (control.gains.noise_share=0.02); may be repeated",
    )
    add("--json", action="store_true", help="print data for scripts")


def run(options: Namespace) -> int:
    """Print the gains; 2 where vehicle, posture or a gain is not right."""
    from uvms_bringup.tuning_page import show_tuning

    return show_tuning(
        options.vehicle, options.control_period, options.posture, options.set, options.json
    )


COMMAND = Command("work out the gains of the control law for a vehicle", add_arguments, run)
