"""Checks before a run starts: do the periods fit together, and does the start fit the vehicle?"""

from uvms_bringup.errors import ScenarioError
from uvms_core.errors import ConfigError
from uvms_core.scene import Obstacles
from uvms_core.sensors import INERTIAL
from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics.geometry import AROUND, build_geometry, clearances_of_poses
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.events import Events, check_events
from uvms_dynamics.simulation.integrator import QUATERNION, VELOCITY
from uvms_dynamics.simulation.plant.as_built import as_built
from uvms_dynamics.simulation.plant.config import check_waves, initial_joints, initial_state
from uvms_dynamics.simulation.plant.stability import check_plant
from uvms_planner import PlannerConfig


def check_start(
    vehicle: Vehicle,
    plant: PlantConfig,
    planner: PlannerConfig,
    seed: int = 1,
    events: Events = (),
    obstacles: Obstacles = (),
) -> None:
    """Check vehicle, plant, planner, events and obstacles against each other.

    Raises:
        ScenarioError: a period is not a multiple of the one that it depends on, the integration
            step is unstable with the vehicle as the plant has it or with a payload, the joints
            cannot start where the plant says, the vehicle starts in an obstacle or the seabed, or
            an event does not fit the vehicle.
    """
    _check_periods(vehicle, plant, planner)
    try:
        step, period = plant.step_s, plant.control_period_s
        check_events(events, vehicle, to_nanoseconds(step), to_nanoseconds(period))
    except ConfigError as fault:
        raise ScenarioError(str(fault)) from fault
    try:
        own = as_built(vehicle, plant, seed).vehicle
        check_waves(own, plant)
        check_plant(own, plant, events)
        initial_joints(own, plant)
    except ConfigError as fault:
        raise ScenarioError(f"plant.{fault}") from fault
    _check_clear(own, plant, obstacles)


def _check_clear(vehicle: Vehicle, plant: PlantConfig, obstacles: Obstacles) -> None:
    if not obstacles and vehicle.environment.seabed_depth_m is None:
        return
    geometry = build_geometry(vehicle, obstacles)
    state = initial_state(vehicle, plant)
    pose = state[None, :QUATERNION], state[None, QUATERNION:VELOCITY]
    distances = clearances_of_poses(geometry, *pose, initial_joints(vehicle, plant)[None])[0]
    around = [
        (distance, pair)
        for distance, pair in zip(distances, geometry.pairs, strict=True)
        if pair.kind in AROUND and distance < 0.0
    ]
    if not around:
        return
    distance, pair = min(around)
    raise ScenarioError(
        f"plant.initial_position_m: the vehicle starts with {pair.body} in {pair.other}, by"
        f" {-distance:.3f} m; start it elsewhere or in another posture"
    )


def _check_periods(vehicle: Vehicle, plant: PlantConfig, planner: PlannerConfig) -> None:
    step = "plant.step_s", plant.step_s
    control = "plant.control_period_s", plant.control_period_s
    rates = {name: sensor.rate_hz for name, sensor in vehicle.sensors.mounted.items()}
    sensors = {
        name: (f"the period of vehicle.sensors.{name}.rate_hz = {rate:g}", 1.0 / rate)
        for name, rate in rates.items()
    }
    for sensor in sensors.values():
        _check_multiple(*sensor, *step)
    _check_multiple(*control, *step)
    # The plant waits for its commands at control ticks, and the IMU sample with the stamp of the
    # tick is what triggers the nodes.
    _check_multiple(*control, *sensors[INERTIAL.name])
    _check_multiple("planner.step_s", planner.step_s, *control)


def _check_multiple(name: str, period: float, base_name: str, base: float) -> None:
    period_ns, base_ns = to_nanoseconds(period), to_nanoseconds(base)
    if base_ns < 1 or period_ns < base_ns or period_ns % base_ns:
        raise ScenarioError(f"{name}: {period:g} s is not a multiple of {base_name}: {base:g} s")
