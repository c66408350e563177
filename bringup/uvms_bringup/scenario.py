"""A scenario: everything that a run depends on, read from a YAML file that a user can copy."""

import re
from collections.abc import Mapping, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

from pydantic import BaseModel, Field, ValidationInfo, field_validator

from uvms_bringup.agenda import Goals
from uvms_bringup.errors import ScenarioError
from uvms_bringup.goal import Goal, start_after
from uvms_bringup.locate import known_scenarios
from uvms_bringup.longest_run import LONGEST_RUN_S
from uvms_bringup.start import check_start
from uvms_control import AllocatorConfig, ControlConfig
from uvms_core.config import Config, validated
from uvms_core.errors import UvmsError
from uvms_core.plugin import PluginConfig
from uvms_core.scene import Obstacles
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_core.vehicle.locate import FILE_SUFFIXES, vehicle_path
from uvms_core.vehicle.postures import STOWED
from uvms_core.yaml_text import parse_yaml, read_yaml
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.events import Events
from uvms_dynamics.simulation.plant.config import initial_joints_deg
from uvms_observer import NavigationConfig, ObserverConfig
from uvms_planner import PlannerConfig

VEHICLE_PREFIX = "vehicle."
OVERRIDES = {
    VEHICLE_PREFIX: ["vehicle_overrides"],
    "plant.vehicle_overrides.": ["plant", "vehicle_overrides"],
}
"""Where settings go that are paths into the vehicle file, by what they begin with."""
LONGEST_ECHO = 200  # characters of a setting that an error repeats


class Scenario(Config):
    """Everything that a run depends on: vehicle, seed, plant, parts of the loop and goal."""

    scenario: str = Field(
        max_length=100, description="name of the scenario; by default that of its file"
    )
    description: str = Field("", description="one sentence that is printed when the run begins")
    vehicle: str = Field(
        "reference_auv",
        description="name of a vehicle that comes with the project, or path of a vehicle file;"
        " relative to the scenario's file, on the command line to the working directory",
    )
    vehicle_overrides: dict[str, Any] = Field(
        default_factory=dict,
        description="values that replace those of the vehicle file, by dotted path, such as"
        " `hull.mass_kg: 190`",
    )
    seed: int = Field(
        1, strict=True, ge=0, le=2**63 - 1, description="seed of all random numbers of the run"
    )
    duration_s: float = Field(gt=0.0, le=LONGEST_RUN_S, description="simulated time of the run, s")
    plant: PlantConfig = Field(
        PlantConfig(), description="the simulated vehicle: integration, start and current"
    )
    obstacles: Obstacles = Field(
        (),
        description="what stands in the water at rest, map_ned; the planner knows of it, and the"
        " seabed is the vehicle file's `environment.seabed_depth_m`",
    )
    navigation: NavigationConfig = Field(
        NavigationConfig(),
        description="navigation filter; its initial_position_m is the plant's unless given",
    )
    observer: ObserverConfig = Field(ObserverConfig(), description="disturbance observer")
    planner: PlannerConfig = Field(PlannerConfig(), description="motion planner")
    allocation: AllocatorConfig = Field(
        AllocatorConfig(), description="distribution of the wrench over the thrusters"
    )
    control: ControlConfig = Field(ControlConfig(), description="vehicle and arm controllers")
    goal: Goal = Field(
        Goal(), description="what the planner is asked for; none: to hold the pose of the start"
    )
    goals: tuple[Goal, ...] = Field(
        (),
        description="several goals instead of one: each begins when the one before it has"
        " succeeded; `frame: start` is then where the goals before it lead",
    )

    events: Events = Field(
        (),
        description="what happens to the plant during the run: payload, faults of thrusters,"
        " sensors and joints, pushes from outside",
    )

    @field_validator("scenario")
    @classmethod
    def _names_a_folder(cls, name: str) -> str:
        if not re.fullmatch(r"\w[\w .+-]*", name):
            raise ValueError(
                "it becomes part of a folder's name: start with a letter or digit, then use"
                " letters, digits, spaces and the signs _ . + -"
            )
        return name

    @field_validator("goals")
    @classmethod
    def _are_goals(cls, own: tuple[Goal, ...], info: ValidationInfo) -> tuple[Goal, ...]:
        if own and info.data.get("goal", Goal()) != Goal():
            raise ValueError("a scenario has either goal or goals")
        for number, goal in enumerate(own):
            if goal == Goal():
                raise ValueError(f"goals.{number}: has none of path, joints and pose")
        return own

    @field_validator("events", mode="before")
    @classmethod
    def _are_events(cls, given: Any) -> Any:
        if not isinstance(given, list | tuple):
            raise ValueError("write a list of events; [] for none")
        return given

    @field_validator("navigation", "observer", "planner", "control", "allocation")
    @classmethod
    def _has_its_part(cls, own: PluginConfig) -> PluginConfig:
        """Find the part that is chosen, with all its parameters, before anything starts."""
        try:
            return own.resolved()
        except UvmsError as fault:
            raise ValueError(str(fault)) from fault

    @field_validator("control")
    @classmethod
    def _knows_the_others(cls, own: ControlConfig, info: ValidationInfo) -> ControlConfig:
        """Gains are laid out for this observer and allocator, unless the scenario says so."""
        allocation, observer = info.data.get("allocation"), info.data.get("observer")
        if allocation is None or observer is None or "gains" in getattr(own.part(), "ignores", {}):
            return own
        compensates = getattr(allocation.part(), "compensates", False)
        told = {
            "lag_compensation": allocation.lag_compensation if compensates else 0.0,
            "external_bandwidth_rad_s": observer.external_bandwidth_rad_s,
        }
        given = own.gains.model_fields_set
        changed = {
            name: value
            for name, value in told.items()
            if name not in given and value != getattr(own.gains, name)
        }
        if not changed:
            return own
        return own.model_copy(update={"gains": own.gains.model_copy(update=changed)})

    @field_validator("planner")
    @classmethod
    def _knows_the_obstacles(cls, own: PlannerConfig, info: ValidationInfo) -> PlannerConfig:
        """The planner knows what stands there, unless the scenario tries what it does not know."""
        obstacles = info.data.get("obstacles")
        if obstacles is None or "obstacles" in own.model_fields_set:
            return own
        return own.model_copy(update={"obstacles": obstacles})

    @field_validator("navigation")
    @classmethod
    def _starts_at_the_plant(cls, own: NavigationConfig, info: ValidationInfo) -> NavigationConfig:
        """The filter knows where the plant starts, unless the scenario tries a wrong start."""
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
        check_start(vehicle, self.plant, self.planner, self.seed, self.events, self.obstacles)
        return vehicle

    def for_vehicle(self, vehicle: Vehicle) -> "Scenario":
        """The same scenario in numbers for this vehicle: no posture names, and the path scaled."""
        angles = initial_joints_deg(vehicle, self.plant)
        start = {"initial_posture": STOWED, "initial_joints_deg": angles}
        goal = self.goal.for_vehicle(vehicle, self.plant)
        goals = tuple(each.for_vehicle(vehicle, self.plant) for each in self.goals)
        plant = self.plant.model_copy(update=start)
        return self.model_copy(update={"plant": plant, "goal": goal, "goals": goals})

    def build_goals(self, vehicle: Vehicle) -> Goals:
        """The goal of a run with this vehicle, or its goals in turn.

        Raises:
            ScenarioError: one of them does not fit; says which.
            VehicleFileError: there is no vehicle `path_made_for`.
        """
        if not self.goals:
            return self.goal.build(vehicle, self.plant)
        built, start = [], self.plant
        for number, goal in enumerate(self.goals):
            try:
                wanted = goal.build(vehicle, start)
            except ScenarioError as fault:
                raise ScenarioError(f"goals.{number}: {fault}") from fault
            start = start_after(wanted, start)
            built.append(wanted)
        return tuple(each for each in built if each is not None)


def load_scenario(
    name: str,
    settings: Sequence[str] = (),
    values: Mapping[str, Any] | None = None,
    **changes: Any,
) -> Scenario:
    """The scenario of that name or file, with `PATH=VALUE` settings and top-level changes applied.

    `values` are settings by path that are no texts, applied after the others.

    Paths in the file are relative to the file, those in settings and changes to the working
    directory; both become absolute.

    Raises:
        ScenarioError: it does not exist, or a value is not allowed; the message says which and why.
    """
    path = _scenario_path(name)
    data = _read_scenario(path)
    _make_absolute(data, path.parent)
    data.setdefault("scenario", path.stem)
    data.update({key: value for key, value in changes.items() if value is not None})
    for setting in settings:
        _apply(data, setting)
    for place, value in (values or {}).items():
        _put(data, place, deepcopy(value), place)  # later values go inside
    _make_absolute(data, Path())
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


def _make_absolute(data: dict[str, Any], folder: Path) -> None:
    """Let every relative path to a vehicle file or a table start at `folder`."""
    _make_file_absolute(data, "vehicle", folder)
    several = data.get("goals")
    for goal in (_group(data, "goal"), *(several if isinstance(several, list) else ())):
        if not isinstance(goal, dict):
            continue
        path = _group(goal, "path")
        _make_file_absolute(goal, "path_made_for", folder)
        for group, name in ((path, "csv"), (_group(path, "csv"), "file")):
            if isinstance(value := group.get(name), str):
                group[name] = str((folder / value).resolve())


def _make_file_absolute(group: dict[str, Any], name: str, folder: Path) -> None:
    """Of a name or file of a vehicle, the file."""
    value = group.get(name)
    if isinstance(value, str) and value.endswith(FILE_SUFFIXES):
        group[name] = str((folder / value).resolve())


def _group(data: dict[str, Any], name: str) -> dict[str, Any]:
    """The group of values of that name; an empty one where there is none."""
    inner = data.get(name)
    return inner if isinstance(inner, dict) else {}


def _apply(data: dict[str, Any], setting: str) -> None:
    path, separator, text = setting.partition("=")
    if not separator or not path:
        raise ScenarioError(f"--set {setting!r}: write PATH=VALUE, such as control.observer=false")
    value = parse_yaml(text, f"--set {_short(setting)!r}: {_short(text)!r}", ScenarioError)
    _put(data, path, value, f"--set {setting!r}")


def _put(data: dict[str, Any], path: str, value: Any, what: str) -> None:
    parents, last = _place(path)
    place: Any = data
    for number, parent in enumerate(parents):
        section = Scenario.field_model(parent) if number == 0 else None
        place = _inside(place, parent, section, what)
        if not isinstance(place, dict | list):
            raise ScenarioError(f"{what}: {parent!r} is a value, not a group of values")
    if isinstance(place, list):
        place[_number(place, last, what)] = value
    else:
        place[last] = value


def _inside(place: Any, name: str, section: type[BaseModel] | None, what: str) -> Any:
    """The group or list of that name, or number, in another one; a section in one word in full."""
    if isinstance(place, list):
        return place[_number(place, name, what)]
    inner = place.setdefault(name, {})
    if section is not None and issubclass(section, PluginConfig):
        inner = place[name] = section.spelled_out(inner)
    return inner


def _number(items: list[Any], name: str, what: str) -> int:
    """An item of a list, such as an event, by its number."""
    if name.isdecimal() and int(name) < len(items):
        return int(name)
    choices = f"one of 0 to {len(items) - 1}" if items else "it has none"
    raise ScenarioError(f"{what}: {name!r} is no item of the list; {choices}")


def _short(text: str) -> str:
    """The text as a message repeats it."""
    return text if len(text) <= LONGEST_ECHO else f"{text[: LONGEST_ECHO - 3]}..."


def _place(path: str) -> tuple[list[str], str]:
    """The groups that a dotted path leads through, and the name in the last of them."""
    for prefix, groups in OVERRIDES.items():  # the rest is one path, into the vehicle file
        if path.startswith(prefix):
            return groups, path.removeprefix(prefix)
    *parents, last = path.split(".")
    return parents, last
