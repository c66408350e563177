"""What `uvms run` and `uvms simulate` have in common: options, session, and what they print."""

import json
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from uvms_bringup.pace import Pace
    from uvms_bringup.session import Session


def add_scenario_options(parser: ArgumentParser, note: str = "", optional: bool = False) -> None:
    """The scenario and how it is run.

    Args:
        note: follows the help of the graph's own options.
        optional: whether another option may stand in the place of the scenario.
    """
    from uvms_bringup.locate import known_scenarios
    from uvms_core import topics

    add = parser.add_argument
    scenarios = ", ".join(known_scenarios())
    add(
        "scenario",
        metavar="SCENARIO",
        nargs="?" if optional else None,
        help=f"{scenarios}, or a YAML file of your own",
    )
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
    add("--json", action="store_true", help="print the summary as JSON, as in summary.json")
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

    scenario = load_scenario(
        options.scenario,
        options.set,
        seed=options.seed,
        duration_s=options.duration,
        vehicle=options.vehicle,
    )
    cast = Cast.parse(options.node, options.without, options.namespace)
    session = prepare(scenario, options.output, str(pace), options.command_line, cast)
    introduce(session, options.json)
    return session


def introduce(session: "Session", as_json: bool) -> None:
    """Print what will be run, and where to."""
    from uvms_core.vehicle import vehicle_warnings

    scenario = session.scenario
    for line in vehicle_warnings(session.vehicle):
        print(f"warning: vehicle: {line}", file=sys.stderr)
    print(
        f"{scenario.scenario}: {scenario.description}\nrun {session.holder.run_id} to"
        f" {session.folder}",
        file=sys.stderr if as_json else None,
        flush=True,
    )


def conclude(session: "Session", run: Callable[[], dict[str, Any]], as_json: bool) -> int:
    """Run, print what came out and where it is; returns the exit code."""
    from uvms_analysis.outcome import EXIT_CODES
    from uvms_bringup.commands.summary_text import summary_text
    from uvms_bringup.session import SUMMARY_FILE
    from uvms_bringup.stopped import Stopped

    try:
        summary = run()
        code = EXIT_CODES[summary["outcome"]]
    except Stopped as stopped:
        print(stopped, file=sys.stderr)
        code, file = stopped.exit_code, session.folder / SUMMARY_FILE
        if not file.exists():  # it never began
            return code
        summary = json.loads(file.read_text(encoding="utf-8"))
    print(json.dumps(summary, indent=2) if as_json else summary_text(summary), flush=True)
    log = session.folder / "run.mcap"
    print(f"log: {log}\nfigures: {sys.argv[0]} report {log}", file=sys.stderr if as_json else None)
    return code
