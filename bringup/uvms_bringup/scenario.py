"""A scenario: what a run is made of, read from a YAML file that a user can copy."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from pydantic import Field, model_validator

from uvms_bringup.errors import ScenarioError
from uvms_control import AllocatorConfig, ControlConfig
from uvms_dynamics import (
    PlantConfig,
    Vehicle,
    build_model,
    end_effector,
    load_vehicle,
)
from uvms_dynamics.config import Config, validated
from uvms_dynamics.rotations import matrix_to_quat, rpy_to_quat
from uvms_dynamics.signals import Array, JointGoal, PathGoal
from uvms_dynamics.vehicle.locate import reference_file
from uvms_observer import NavigationConfig, ObserverConfig
from uvms_planner import PathSpec, PlannerConfig

VEHICLE_PREFIX = "vehicle."


class JointMotion(Config):
    """A motion of the joints alone, from rest to rest between its points."""

    times_s: tuple[float, ...] = Field(description="s after the start, of each point")
    positions_deg: tuple[tuple[float, ...], ...] = Field(description="joint angles at each point")

    def goal(self) -> JointGoal:
        """The goal in SI units."""
        return JointGoal(np.array(self.times_s), np.deg2rad(np.array(self.positions_deg)))


class Goal(Config):
    """What is asked of the planner: a path of the end effector, a joint motion, or nothing."""

    path: PathSpec | None = Field(None, description="path of the end effector from where it starts")
    joints: JointMotion | None = Field(None, description="motion of the joints")

    @model_validator(mode="after")
    def _one_of_them(self) -> "Goal":
        if self.path is not None and self.joints is not None:
            raise ValueError("a goal has `path` or `joints`, not both")
        return self

    def build(self, vehicle: Vehicle, plant: PlantConfig) -> PathGoal | JointGoal | None:
        """The goal of a run that starts as `plant` says."""
        if self.path is not None:
            return self.path.goal(*start_of_end_effector(vehicle, plant))
        return self.joints.goal() if self.joints is not None else None

    @property
    def duration_s(self) -> float:
        """How long the goal takes."""
        if self.path is not None:
            return self.path.duration_s
        return self.joints.times_s[-1] if self.joints is not None else 0.0


class Scenario(Config):
    """Everything that a run depends on, with the seed and the vehicle."""

    scenario: str = Field(description="name, as in the file's name")
    description: str = Field("", description="one sentence for the user")
    vehicle: str = Field("reference_auv", description="vehicle file: a path, or a name in config/")
    vehicle_overrides: dict[str, Any] = Field(
        default_factory=dict, description="values of the vehicle file to change: dotted path: value"
    )
    seed: int = Field(1, ge=0, description="of every random number of the run")
    duration_s: float = Field(gt=0.0, description="simulated time of the run, s")
    plant: PlantConfig = PlantConfig()
    navigation: NavigationConfig = NavigationConfig()
    observer: ObserverConfig = ObserverConfig()
    planner: PlannerConfig = PlannerConfig()
    control: ControlConfig = ControlConfig()
    allocation: AllocatorConfig = AllocatorConfig()
    goal: Goal = Goal()

    def load_vehicle(self) -> Vehicle:
        """The vehicle with this scenario's overrides."""
        return load_vehicle(_vehicle_path(self.vehicle), self.vehicle_overrides)


def start_of_end_effector(vehicle: Vehicle, plant: PlantConfig) -> tuple[Array, Array]:
    """Position (3,) m and quaternion (4,) of the tool in map_ned at the start of a run."""
    position, R_world_tool = end_effector(
        build_model(vehicle),
        np.array(plant.initial_position_m, dtype=float),
        rpy_to_quat(*np.deg2rad(np.array(plant.initial_rpy_deg, dtype=float))),
        np.deg2rad(np.array(plant.initial_joints_deg, dtype=float)),
    )
    return position, matrix_to_quat(R_world_tool)


def known_scenarios() -> dict[str, Path]:
    """Scenarios that come with the project, by name."""
    folder = reference_file().parent / "scenarios"
    return {path.stem: path for path in sorted(folder.glob("*.yaml"))}


def load_scenario(name: str, settings: Sequence[str] = (), **changes: Any) -> Scenario:
    """The scenario of that name or file, with `PATH=VALUE` settings and top-level changes applied.

    Raises:
        ScenarioError: it does not exist, or a value is not allowed; the message says which and why.
    """
    path = _scenario_path(name)
    data = _read_yaml(path)
    data.setdefault("scenario", path.stem)
    data.update({key: value for key, value in changes.items() if value is not None})
    for setting in settings:
        _apply(data, setting)
    return validated(Scenario, data, f"scenario {path.name}", ScenarioError)


def _scenario_path(name: str) -> Path:
    path = Path(name)
    if path.suffix in (".yaml", ".yml"):
        if path.is_file():
            return path
        raise ScenarioError(f"scenario file {name!r} does not exist")
    known = known_scenarios()
    if name not in known:
        choices = ", ".join(known)
        raise ScenarioError(f"unknown scenario {name!r}; choose one of {choices}, or a YAML file")
    return known[name]


def _vehicle_path(name: str) -> Path:
    path = Path(name)
    if path.suffix in (".yaml", ".yml"):
        return path
    return reference_file().with_name(f"{name}.yaml")


def _read_yaml(path: Path) -> dict[str, Any]:
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as fault:
        raise ScenarioError(f"{path}: {fault}") from fault
    if not isinstance(data, dict):
        raise ScenarioError(f"{path}: a scenario is a mapping of names to values")
    return data


def _apply(data: dict[str, Any], setting: str) -> None:
    path, separator, text = setting.partition("=")
    if not separator or not path:
        raise ScenarioError(f"--set {setting!r}: write PATH=VALUE, such as control.observer=false")
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as fault:
        raise ScenarioError(f"--set {setting!r}: {text!r} is not a YAML value") from fault
    if path.startswith(VEHICLE_PREFIX):
        data.setdefault("vehicle_overrides", {})[path.removeprefix(VEHICLE_PREFIX)] = value
        return
    *parents, last = path.split(".")
    for parent in parents:
        data = data.setdefault(parent, {})
        if not isinstance(data, dict):
            raise ScenarioError(f"--set {setting!r}: {parent!r} is a value, not a group of values")
    data[last] = value
