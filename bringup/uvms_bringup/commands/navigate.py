"""The command `uvms navigate`: the navigation filter over a recorded log."""

import json
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from typing import Any

from uvms_core.command import Command

DESCRIPTION = """Run the navigation filter over a log: MCAP or SQLite (.db3), a file or the folder
of a bag, recorded by this system or by any other with standard sensor messages. Writes the estimate
as nav_msgs/Odometry to DIR/odometry.mcap and what came of it to DIR/summary.json; where the log has
a reference, its error is printed."""
EPILOG = """topics:
  imu           sensor_msgs/Imu                           needed: attitude, rates, specific force
  dvl           geometry_msgs/TwistWithCovarianceStamped  velocity over ground
  pressure      sensor_msgs/FluidPressure                 absolute, Pa
  gps           sensor_msgs/NavSatFix
  position_fix  geometry_msgs/PoseWithCovarianceStamped   in map or map_ned
  reference     nav_msgs/Odometry or geometry_msgs/PoseStamped, to compare with
and any further sensor of the vehicle file, by its name there. A topic that is the only one of its
type need not be named. `dvl=none` leaves a sensor out.

The vehicle file says where the sensors are mounted, along which axes they measure and how noisy
they are; a copy of the nearest one that is shipped is a good beginning.

examples:
  uvms navigate runs/one/run.mcap                         a run of our own needs nothing else
  uvms navigate survey.mcap --vehicle my_rov.yaml
  uvms navigate bag_folder --vehicle my_rov.yaml --topics imu=/xsens/data dvl=/dvl/twist
  uvms navigate survey.db3 --vehicle my_rov.yaml --topics topics.yaml reference=/usbl/pose
"""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms navigate`."""
    from uvms_core.vehicle.locate import known_vehicles

    parser.description, parser.epilog = DESCRIPTION, EPILOG
    parser.formatter_class = RawDescriptionHelpFormatter
    add = parser.add_argument
    add("log", metavar="LOG", help=".mcap or .db3 file, or the folder of a bag")
    add(
        "--vehicle",
        metavar="VEHICLE",
        help=f"one of {', '.join(known_vehicles())}, or a YAML file (default: that of the log, if a"
        " run of this system made it)",
    )
    add(
        "--topics",
        metavar="MAP",
        nargs="+",
        default=[],
        help="SENSOR=TOPIC, or a YAML file that maps sensors to topics",
    )
    add(
        "--stamps",
        choices=("header", "log"),
        default="header",
        help="time of a measurement: that of its header (default), or when it was recorded",
    )
    add("--output", metavar="DIR", help="folder of the results (default: LOG-navigation beside it)")
    add("--json", action="store_true", help="print the summary as JSON")


def run(options: Namespace) -> int:
    """Navigate the log and print the summary."""
    from uvms_bringup.navigate.navigate import navigate
    from uvms_bringup.navigate.topic_map import given_topics

    given = given_topics(options.topics)
    summary = navigate(options.log, options.vehicle, given, options.output, options.stamps)
    print(json.dumps(summary, indent=2) if options.json else text(summary))
    return 0


def text(summary: dict[str, Any]) -> str:
    """The summary for people."""
    lines = [f"note: {each}" for each in summary["notes"]]
    if summary["log_fault"]:
        lines.append(f"note: the log: {summary['log_fault']}; what is whole was used")
    lines.append(
        f"{summary['estimates']} estimates over {summary['duration_s']:.1f} s of"
        f" {summary['vehicle']}, in {summary['output']}"
    )
    lines += [_sensor(name, summary) for name in summary["topics"]]
    if summary["trouble"]:
        lines.append(f"trouble: {summary['trouble']}")
    if summary["restarts"]:
        lines.append(f"started anew after {summary['restarts']} holes in the log")
    return "\n".join([*lines, *_errors(summary)])


def _sensor(name: str, summary: dict[str, Any]) -> str:
    """One line: topic, messages, what was not used, health, residuals."""
    topic, counts = summary["topics"][name], summary["counts"]
    unreadable = summary["unreadable"].get(topic, 0)
    parts = [f"{summary['messages'][name]} messages"]
    if unreadable:
        parts.append(f"{unreadable} unreadable (first: {summary['first_unreadable'][topic]})")
    if gated := counts.get(f"{name}_gated", 0):
        parts.append(f"{gated} refused")
    if (nis := summary["normalized_innovation_squared"].get(name)) is not None:
        parts.append(f"residuals {nis:.2f} of 1")
    if name in summary["health"]:
        parts.append(summary["health"][name])
    return f"  {name:<13} {topic}: {', '.join(parts)}"


def _errors(summary: dict[str, Any]) -> list[str]:
    if "position_error_m" not in summary:
        return []
    position, attitude = summary["position_error_m"], summary["attitude_error_deg"]
    return [
        f"against {summary['reference']} over {summary['distance_travelled_m']:.1f} m of way:",
        f"  position: median {position['median']:.4g} m, 95 % {position['p95']:.4g} m, largest"
        f" {position['max']:.4g} m, at the end {position['end']:.4g} m;"
        f" {100 * summary['position_inside_3_sigma']:.2f} % in 3 sigma",
        f"  attitude: median {attitude['median']:.3g} deg, largest {attitude['max']:.3g} deg;"
        f" {100 * summary['attitude_inside_3_sigma']:.2f} % in 3 sigma",
    ]


COMMAND = Command(
    "run the navigation filter over a log of this or another system", add_arguments, run
)
