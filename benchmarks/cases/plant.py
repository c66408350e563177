"""The plant with its sensors, one control period after the other, against real time."""

from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from paired import processor_seconds_per_call

from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.simulation import Plant, PlantConfig

PERIODS, ROUNDS = 100, 9


def measure(full: bool) -> Iterator[Metric]:
    """Runge-Kutta at 200 Hz and all sensors at their rates, under steady small commands."""
    vehicle, config = load_vehicle(), PlantConfig()
    plant = Plant(vehicle, config, seed=1)
    thrust = np.linspace(-1.0, 1.0, vehicle.n_thrusters)
    effort = np.zeros(vehicle.n_joints)

    def period() -> None:
        plant.step(ThrusterCommand(plant.stamp, thrust), JointCommand(plant.stamp, effort))
        plant.sense()
        plant.truth()

    period()
    seconds = np.array([processor_seconds_per_call(period, PERIODS) for _ in range(ROUNDS)])
    factor = float(np.median(config.control_period_s / seconds))
    yield Metric(
        "plant_and_sensors", factor, "x real time", "real time; processor time of one core", factor,
        Target("value", ">=", 100.0),
    )  # fmt: skip
