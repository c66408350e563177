"""A scenario: what a run is made of, read from a YAML file that a user can copy."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import Field, ValidationInfo, field_validator, model_validator

from uvms_bringup.errors import ScenarioError
from uvms_bringup.locate import known_scenarios
from uvms_bringup.start import check_start
from uvms_control import AllocatorConfig, ControlConfig
from uvms_core.config import Config, validated
from uvms_core.errors import UvmsError
from uvms_core.plugin import PluginConfig
from uvms_core.signals import Array, JointGoal, PathGoal
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_core.vehicle.locate import FILE_SUFFIXES, vehicle_path
from uvms_core.yaml_text import parse_yaml, read_yaml
from uvms_dynamics import build_model, end_effector
from uvms_dynamics.kernels.rotations import matrix_to_quat, rpy_to_quat
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.plant.config import initial_joints
from uvms_observer import NavigationConfig, ObserverConfig
from uvms_planner import PathSpec, PlannerConfig

VEHICLE_PREFIX = "vehicle."
LONGEST_RUN_S = 1e6


class JointMotion(Config):
    """A motion of the joints alone, from rest to rest between its points."""

    times_s: tuple[float, ...] = Field(
        min_length=1, description="s after the start, of each point; increasing, > 0"
    )
    positions_deg: tuple[tuple[float, ...], ...] = Field(description="joint angles at each point")

    @model_validator(mode="after")
    def _is_table(self) -> "JointMotion":
        pairs = zip((0.0, *self.times_s), self.times_s, strict=False)
        if not all(before < after for before, after in pairs):
            raise ValueError(f"times_s must be > 0 and increasing, are {list(self.times_s)}")
        if len(self.positions_deg) != len(self.times_s):
            raise ValueError(
                f"positions_deg has {len(self.positions_deg)} rows for {len(self.times_s)} times"
            )
        lengths = [len(row) for row in self.positions_deg]
        if len(set(lengths)) > 1 or not lengths[0]:
            raise ValueError(
                "every row of positions_deg needs as many values, one a joint;"
                f" the rows have {', '.join(map(str, lengths))}"
            )
        return self

    def check(self, vehicle: Vehicle) -> None:
        """Raise ScenarioError unless every row has a value for each joint of the vehicle."""
        if (count := len(self.positions_deg[0])) != vehicle.n_joints:
            raise ScenarioError(
                f"goal.joints.positions_deg: its rows have {count} values, the vehicle"
                f" {vehicle.name!r} has {vehicle.n_joints} joints: {', '.join(vehicle.joint_names)}"
            )

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
        if self.joints is not None:
            self.joints.check(vehicle)
            return self.joints.goal()
        return None

    @property
    def duration_s(self) -> float:
        """How long the goal takes."""
        if self.path is not None:
            return self.path.duration_s
        return self.joints.times_s[-1] if self.joints is not None else 0.0


class Scenario(Config):
    """Everything that a run depends on, with the seed and the vehicle."""

    scenario: str = Field(max_length=100, description="name, as in the file's name")
    description: str = Field("", description="one sentence for the user")
    vehicle: str = Field("reference_auv", description="vehicle file: a path, or a name in config/")
    vehicle_overrides: dict[str, Any] = Field(
        default_factory=dict, description="values of the vehicle file to change: dotted path: value"
    )
    seed: int = Field(1, ge=0, le=2**63 - 1, description="of every random number of the run")
    duration_s: float = Field(gt=0.0, le=LONGEST_RUN_S, description="simulated time of the run, s")
    plant: PlantConfig = PlantConfig()
    navigation: NavigationConfig = Field(
        NavigationConfig(),
        description="its initial_position_m is the plant's where the scenario gives none",
    )
    observer: ObserverConfig = ObserverConfig()
    planner: PlannerConfig = PlannerConfig()
    control: ControlConfig = ControlConfig()
    allocation: AllocatorConfig = AllocatorConfig()
    goal: Goal = Goal()

    @field_validator("scenario")
    @classmethod
    def _names_a_folder(cls, name: str) -> str:
        if not re.fullmatch(r"\w[\w .+-]*", name):
            raise ValueError(
                "it becomes a part of a folder's name: begin with a letter or digit, and go on with"
                " letters, digits, spaces and the signs _ . + -"
            )
        return name

    @field_validator("navigation", "observer", "planner", "control", "allocation")
    @classmethod
    def _has_its_part(cls, own: PluginConfig) -> PluginConfig:
        """Find the part that is chosen, with all its parameters, before anything starts."""
        try:
            return own.resolved()
        except UvmsError as fault:
            raise ValueError(str(fault)) from fault

    @field_validator("navigation")
    @classmethod
    def _begins_at_the_plant(cls, own: NavigationConfig, info: ValidationInfo) -> NavigationConfig:
        """Where the mission starts is known, unless the scenario tries what a wrong start does."""
        plant = info.data.get("plant")
        if plant is None or "initial_position_m" in own.model_fields_set:
            return own
        return own.model_copy(update={"initial_position_m": plant.initial_position_m})

    def load_vehicle(self) -> Vehicle:
        """The vehicle with this scenario's overrides.

        Raises:
            VehicleFileError: its file or an override is not right.
            ScenarioError: there is no such vehicle, or the run cannot start with it.
        """
        vehicle = load_vehicle(vehicle_path(self.vehicle), self.vehicle_overrides)
        check_start(vehicle, self.plant, self.planner)
        return vehicle


def start_of_end_effector(vehicle: Vehicle, plant: PlantConfig) -> tuple[Array, Array]:
    """Position (3,) m and quaternion (4,) of the tool in map_ned at the start of a run."""
    position, R_world_tool = end_effector(
        build_model(vehicle),
        np.array(plant.initial_position_m, dtype=float),
        rpy_to_quat(*np.deg2rad(np.array(plant.initial_rpy_deg, dtype=float))),
        initial_joints(vehicle, plant),
    )
    return position, matrix_to_quat(R_world_tool)


def load_scenario(name: str, settings: Sequence[str] = (), **changes: Any) -> Scenario:
    """The scenario of that name or file, with `PATH=VALUE` settings and top-level changes applied.

    Raises:
        ScenarioError: it does not exist, or a value is not allowed; the message says which and why.
    """
    path = _scenario_path(name)
    data = _read_scenario(path)
    data.setdefault("scenario", path.stem)
    data.update({key: value for key, value in changes.items() if value is not None})
    for setting in settings:
        _apply(data, setting)
    return validated(Scenario, data, f"scenario {path.name}", ScenarioError)


def _scenario_path(name: str) -> Path:
    path = Path(name)
    if path.suffix in FILE_SUFFIXES:
        if path.is_file():
            return path
        raise ScenarioError(f"scenario file {name!r} does not exist")
    known = known_scenarios()
    if name not in known:
        choices = ", ".join(known)
        raise ScenarioError(f"unknown scenario {name!r}; choose one of {choices}, or a YAML file")
    return known[name]


def _read_scenario(path: Path) -> dict[str, Any]:
    data = read_yaml(path, f"scenario {path}", ScenarioError)
    if not isinstance(data, dict):
        raise ScenarioError(f"scenario {path}: a scenario is a mapping of names to values")
    return data


def _apply(data: dict[str, Any], setting: str) -> None:
    path, separator, text = setting.partition("=")
    if not separator or not path:
        raise ScenarioError(f"--set {setting!r}: write PATH=VALUE, such as control.observer=false")
    value = parse_yaml(text, f"--set {setting!r}: {text!r}", ScenarioError)
    parents, last = _place(path)
    for parent in parents:
        data = data.setdefault(parent, {})
        if not isinstance(data, dict):
            raise ScenarioError(f"--set {setting!r}: {parent!r} is a value, not a group of values")
    data[last] = value


def _place(path: str) -> tuple[list[str], str]:
    """The groups that a dotted path leads through, and the name in the last of them."""
    if path.startswith(VEHICLE_PREFIX):  # its own path goes to the vehicle file's overrides
        return ["vehicle_overrides"], path.removeprefix(VEHICLE_PREFIX)
    *parents, last = path.split(".")
    return parents, last
