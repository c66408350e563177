"""The command `uvms`: run, simulate, replay, report."""

import argparse
import json
import shlex
import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

from uvms_analysis.trials.commands import add_commands as add_trial_commands
from uvms_bringup import added_mass
from uvms_bringup.cast import Cast
from uvms_bringup.pace import Pace
from uvms_bringup.scenario import known_scenarios, load_scenario
from uvms_bringup.session import Session, prepare
from uvms_core import topics
from uvms_core.errors import UvmsError

EXAMPLES = """examples:
  uvms run manipulation                        the 900 s manipulation on six ROS 2 nodes
  uvms run arm_swing --set control.observer=false --output runs/without_observer
  uvms simulate hover --seed 3 --duration 20   the same loop in one process, without ROS
  uvms report runs/without_observer/run.mcap   figures and a page about a run
  uvms replay runs/without_observer/run.mcap --into controller
  uvms added-mass spheroid:2.4,0.38            added mass of a shape or of a mesh file
  uvms validate bringup/data/pool_trials --vehicle bluerov2_alpha5
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; errors of ours end in one clear message and code 2."""
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    options = parser().parse_args(arguments)
    options.command = "uvms " + shlex.join(arguments)
    try:
        return options.do(options)
    except (UvmsError, OSError) as fault:  # OSError: the disk is full, a folder may not be written
        print(f"error: {fault}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130


def parser() -> argparse.ArgumentParser:
    """All commands and options."""
    top = argparse.ArgumentParser(
        prog="uvms",
        description="An underwater vehicle with an arm: run it, simulate it, work on its logs.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"uvms {version('uvms_bringup')}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    for name, action, text in (
        ("run", run, "run a scenario on the ROS 2 node graph, recorded to MCAP"),
        ("simulate", simulate, "run a scenario in one process without ROS, logged alike"),
    ):
        _add_run(commands, name, action, text)
    _add_replay(commands)
    _add_report(commands)
    added_mass.add_command(commands)
    add_trial_commands(commands)
    return top


def _add_run(commands: Any, name: str, action: Any, text: str) -> None:
    scenarios = ", ".join(known_scenarios())
    beside = "" if action is run else " (for `uvms run`; has no effect here)"
    command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
    command.set_defaults(do=action)
    add = command.add_argument
    add("scenario", metavar="SCENARIO", help=f"{scenarios}, or a YAML file of your own")
    add("--seed", type=int, metavar="N", help="seed of all random numbers (default: scenario's)")
    add("--duration", type=float, metavar="S", help="simulated seconds (default: scenario's)")
    add(
        "--pace",
        default="lockstep",
        metavar="PACE",
        help="lockstep: repeatable, as fast as the machine (default); realtime or realtime:FACTOR: "
        "by the clock on the wall" + beside,
    )
    add(
        "--composed",
        action="store_true",
        help="all nodes in one process: several times faster" + beside,
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
    add(
        "--node",
        action="append",
        default=[],
        metavar="ROLE=NODE",
        help=f"your node in the place of ours, as controller=my_package.my_node:MyController;"
        f" ROLE is one of {', '.join(topics.NODES)}",
    )
    add(
        "--without",
        action="append",
        default=[],
        metavar="ROLE",
        help="do not start this node: you start it, and the run waits for it",
    )


def _add_replay(commands: Any) -> None:
    text = "publish a log again with /clock, or feed one node with its recorded inputs"
    command = commands.add_parser("replay", help=text, description=f"{text[0].upper()}{text[1:]}.")
    command.set_defaults(do=replay)
    add = command.add_argument
    add("log", metavar="RUN.mcap", help="log of a run")
    add(
        "--into",
        metavar="NODE",
        help="start this node, feed it and compare what it answers with the log: "
        + ", ".join(topics.NODES),
    )
    add(
        "--rate",
        type=float,
        default=None,
        metavar="FACTOR",
        help="speed against real time (default 1; with --into as fast as the node answers)",
    )
    add("--output", metavar="DIR", help="folder for what --into records (default: beside the log)")


def _add_report(commands: Any) -> None:
    text = "figures and an HTML page about a run"
    command = commands.add_parser("report", help=text, description=f"{text[0].upper()}{text[1:]}.")
    command.set_defaults(do=report)
    command.add_argument("log", metavar="RUN.mcap", help="log of a run")
    command.add_argument("--output", metavar="DIR", help="where to (default: beside the log)")


def _session(options: argparse.Namespace, pace: Pace) -> Session:
    scenario = load_scenario(
        options.scenario,
        options.set,
        seed=options.seed,
        duration_s=options.duration,
        vehicle=options.vehicle,
    )
    cast = Cast.parse(options.node, options.without, options.namespace)
    session = prepare(scenario, options.output, str(pace), options.command, cast)
    print(f"{scenario.scenario}: {scenario.description}\nto {session.folder}", flush=True)
    return session


def run(options: argparse.Namespace) -> int:
    """`uvms run`."""
    pace = Pace.parse(options.pace)
    session = _session(options, pace)
    return _tell(session, session.run_graph(pace, options.composed))


def simulate(options: argparse.Namespace) -> int:
    """`uvms simulate`: takes the options of `uvms run`, and says which have no effect."""
    lockstep, asked = Pace(), Pace.parse(options.pace)
    given = {f"--pace {asked}": asked != lockstep, "--composed": options.composed}
    if idle := [name for name, is_given in given.items() if is_given]:
        print(
            f"note: {' and '.join(idle)}: no effect on `uvms simulate`, which always runs in one"
            " process, as fast as the machine; `uvms run` heeds it",
            file=sys.stderr,
        )
    session = _session(options, lockstep)
    return _tell(session, session.run_simulation())


def replay(options: argparse.Namespace) -> int:
    """`uvms replay`."""
    from uvms_bringup.ros.replay import replay as play  # ROS is wanted here only

    return play(options.log, into=options.into, rate=options.rate, output=options.output)


def report(options: argparse.Namespace) -> int:
    """`uvms report`."""
    from uvms_analysis.report import report as make  # matplotlib takes its time

    page = make(options.log, options.output)
    print(page)
    return 0


def _tell(session: Session, summary: dict[str, Any]) -> int:
    print(json.dumps(summary, indent=2))
    log = session.folder / "run.mcap"
    print(f"log: {log}\nfigures: {sys.argv[0]} report {log}")
    return 0 if summary["completed"] else 1


if __name__ == "__main__":
    raise SystemExit(main())
