"""What `uvms run` and `uvms simulate` have in common: options, session, and what they print."""

import json
import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from uvms_bringup.pace import Pace
    from uvms_bringup.session import Session


def add_scenario_options(parser: ArgumentParser, note: str = "") -> None:
    """The scenario and how it is run; `note` follows the help of the graph's own options."""
    from uvms_bringup.locate import known_scenarios
    from uvms_core import topics

    add = parser.add_argument
    scenarios = ", ".join(known_scenarios())
    add("scenario", metavar="SCENARIO", help=f"{scenarios}, or a YAML file of your own")
    add("--seed", type=int, metavar="N", help="seed of all random numbers (default: scenario's)")
    add("--duration", type=float, metavar="S", help="simulated seconds (default: scenario's)")
    add(
        "--pace",
        default="lockstep",
        metavar="PACE",
        help="lockstep: repeatable, as fast as the machine (default); realtime or realtime:FACTOR: "
        "by the clock on the wall" + note,
    )
    add(
        "--composed",
        action="store_true",
        help="all nodes in one process: several times faster" + note,
    )
    add("--vehicle", metavar="FILE", help="vehicle file (default: scenario's)")
    add(
        "--set",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="change a value of the scenario (control.observer=false) or of the vehicle file "
        "(vehicle.hull.mass_kg=190); may be repeated",
    )
    add("--output", metavar="DIR", help="folder of the run (default: runs/SCENARIO-TIME)")
    add("--namespace", default="", metavar="NAME", help="ROS namespace of all topics and nodes")
    roles = ", ".join(topics.NODES)
    add(
        "--node",
        action="append",
        default=[],
        metavar="ROLE=NODE",
        help="your node in the place of ours, as controller=my_package.my_node:MyNode; ROLE is one"
        f" of {roles}; may be repeated" + note,
    )
    add(
        "--without",
        action="append",
        default=[],
        metavar="ROLE",
        help="leave this node to you: the run waits until you have started it" + note,
    )


def open_session(options: Namespace, pace: "Pace") -> "Session":
    """Read the scenario with its changes, and make the folder of the run.

    Raises:
        ScenarioError, VehicleFileError, RunError: as `load_scenario` and `prepare`.
    """
    from uvms_bringup.cast import Cast
    from uvms_bringup.scenario import load_scenario
    from uvms_bringup.session import prepare
    from uvms_core.vehicle import vehicle_warnings

    scenario = load_scenario(
        options.scenario,
        options.set,
        seed=options.seed,
        duration_s=options.duration,
        vehicle=options.vehicle,
    )
    cast = Cast.parse(options.node, options.without, options.namespace)
    session = prepare(scenario, options.output, str(pace), options.command_line, cast)
    for line in vehicle_warnings(session.vehicle):
        print(f"warning: vehicle: {line}", file=sys.stderr)
    print(f"{scenario.scenario}: {scenario.description}\nto {session.folder}", flush=True)
    return session


def print_summary(session: "Session", summary: dict[str, Any]) -> int:
    """Print what came out and where it is; returns the exit code."""
    print(json.dumps(summary, indent=2))
    log = session.folder / "run.mcap"
    print(f"log: {log}\nfigures: {sys.argv[0]} report {log}")
    return 0 if summary["completed"] else 1
