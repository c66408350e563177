"""The parameters of each node of a run, from the scenario; also as a file."""

from pathlib import Path
from typing import Any

from uvms_bringup.pace import Pace
from uvms_bringup.scenario import Scenario
from uvms_core import topics
from uvms_core.config import Config
from uvms_core.ros.parameters import flatten
from uvms_core.yaml_text import dump_yaml
from uvms_dynamics.simulation.events import EventsConfig


def node_parameters(
    scenario: Scenario, vehicle_file: Path, pace: Pace, run_id: str = ""
) -> dict[str, dict[str, Any]]:
    """ROS parameters by node; `run_id` is that of the run, empty outside one."""
    common = {
        "vehicle_file": str(vehicle_file),
        "seed": scenario.seed,
        "pace": pace.name,
        "run_id": run_id,
        "control_period_s": scenario.plant.control_period_s,
    }
    own = {node: common | _own(scenario, node) for node in topics.NODES}
    own[topics.PLANT] |= flatten(EventsConfig(events=scenario.events)) | {
        "realtime_factor": pace.factor,
        "duration_s": scenario.duration_s,
        "auto_start": False,
        "start_paused": True,
    }
    return own


def write_parameter_file(path: Path, node: str, parameters: dict[str, Any]) -> Path:
    """Write one node's parameters in ROS's YAML form, under any namespace."""
    content = {f"/**/{node}": {"ros__parameters": parameters}}
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(dump_yaml(content), encoding="utf-8")
    return path


def _own(scenario: Scenario, node: str) -> dict[str, Any]:
    return flatten(config_of(scenario, node))


def config_of(scenario: Scenario, node: str) -> Config:
    """The part of a scenario that configures one node."""
    return {
        topics.PLANT: scenario.plant,
        topics.NAVIGATION: scenario.navigation,
        topics.DISTURBANCE_OBSERVER: scenario.observer,
        topics.MOTION_PLANNER: scenario.planner,
        topics.CONTROLLER: scenario.control,
        topics.THRUST_ALLOCATOR: scenario.allocation,
    }[node]
