"""Stamps as drivers give them: off the grid of the control loop, since 1970, with jitter, at odd
rates. The odometry comes at the control period all the same, and is right.
"""

from dataclasses import replace

import numpy as np
import pytest
from sensor_truth import Motion, Rig, Waves

from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_core.tick_gate import TickGate
from uvms_core.vehicle import load_vehicle
from uvms_observer.arrivals import used_sensors
from uvms_observer.navigation import NavigationConfig
from uvms_observer.parts import NavigationPart

PERIOD = to_nanoseconds(0.05)
SECONDS = 20.0
MOTION = Motion(
    Waves((0, 0, 10), (0.3, 0.1, 0), (2.0, 1.0, 0.3), (60.0, 45.0, 40.0)),
    Waves((0.02, -0.03, 0.2), amplitude=(0.03, 0.02, 0.4), period_s=(9.0, 13.0, 50.0)),
)


def arrivals(vehicle, begin, jitter):
    """(sensor, sample) in the order of their stamps; GPS does not take part."""
    rig, rng, found = Rig(vehicle, MOTION, 3), np.random.default_rng(1), []
    for name in ("imu", "dvl", "pressure"):
        rate = getattr(vehicle.sensors, name).rate_hz
        times = np.arange(round(SECONDS * rate)) / rate
        times = np.sort(np.abs(times + jitter * np.clip(rng.standard_normal(len(times)), -2, 2)))
        found += [(name, sample) for sample in getattr(rig, name)(times)]
    found.sort(key=lambda pair: pair[1].stamp)
    return [(name, replace(sample, stamp=begin + sample.stamp)) for name, sample in found]


def odometries(vehicle, begin, jitter):
    start = tuple(map(float, MOTION.position(0.0)))
    part = NavigationPart(vehicle, NavigationConfig(initial_position_m=start), PERIOD)
    inputs = {topic.name: item for topic, item in part.inputs.items()}
    gate = TickGate(inputs, part.trigger.name, lockstep=False, every=part.every)
    names = {sensor.name: sensor.topic.name for sensor in used_sensors(vehicle)}
    for name, sample in arrivals(vehicle, begin, jitter):
        for tick in gate.push(names[name], sample.stamp, sample):
            yield from (signal for _, signal in part.step(tick))
            assert not part.take_faults()


@pytest.mark.parametrize("rate", [97.0, 100.0, 250.0])
@pytest.mark.parametrize(
    ("begin", "jitter"), [(0.0, 0.0), (0.001, 0.0), (0.001, 0.001), (1.7e9 + 0.013, 0.002)]
)
def test_odometry_comes_at_the_control_period_and_is_right(rate, begin, jitter):
    vehicle = load_vehicle(overrides={"sensors.imu.rate_hz": rate})
    found = list(odometries(vehicle, to_nanoseconds(begin), jitter))
    assert len(found) >= SECONDS / to_seconds(PERIOD) - 2
    assert {odometry.stamp % PERIOD for odometry in found} == {0}
    for odometry in found[20:]:
        true = MOTION.position(to_seconds(odometry.stamp - to_nanoseconds(begin)))
        error = true - odometry.position
        assert error @ np.linalg.solve(odometry.pose_covariance[:3, :3], error) < 3.8**2
