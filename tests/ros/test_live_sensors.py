"""The navigation node on sensors as they are at sea: off the grid, doubled, and failing."""

from functools import partial

import numpy as np
import pytest
from drivers import Driver, Habits
from in_process import graph_of, parameters, spin_until
from rclpy.qos import QoSProfile

from uvms_core import topics
from uvms_core.vehicle import dump_vehicle, load_vehicle
from uvms_observer.nodes.navigation import NavigationNode

LEVER = [-0.4, 0.1, 0.1]
DOUBLED = {
    "sensors.gps": None,
    "sensors.dvl_aft": {
        "type": "dvl", "rate_hz": 8.0, "position_m": LEVER, "noise_m_s": 0.004, "scale_error": 0.0
    },
    "sensors.pressure_aft": {
        "type": "pressure", "rate_hz": 10.0, "position_m": LEVER, "noise_pa": 80.0, "bias_pa": 0.0
    },
}  # fmt: skip
OURS = {"topic": "sensors/imu", "frame": "imu_link_fsd", "is_enu": False}
OFF_GRID = Habits(since=3_000_000, jitter_s=0.0, rate_hz=100.0, qos=QoSProfile(depth=10), **OURS)
JITTER = Habits(jitter_s=2e-3, rate_hz=97.0, **OURS)


def told(driver):
    """What navigation says of its sensors, the last time."""
    said = [s for s in driver.heard[topics.DIAGNOSTICS.name] if s.name == topics.NAVIGATION]
    return said[-1].message if said else ""


@pytest.mark.parametrize("habits", [OFF_GRID, JITTER], ids=["off_grid", "jitter"])
def test_two_of_a_kind_are_used_together_and_one_is_enough(tmp_path, habits):
    """Right in 3 sigma along each axis with both, and when the first of each has failed."""
    path = tmp_path / "vehicle.yaml"
    path.write_text(dump_vehicle(load_vehicle(overrides=DOUBLED)), encoding="utf-8")
    vehicle = load_vehicle(str(path))

    def navigation():
        return NavigationNode(
            parameter_overrides=parameters(pace="realtime", vehicle_file=str(path))
        )

    with graph_of(navigation, partial(Driver, vehicle, habits)) as (spinner, (node, driver)):
        ready = [driver.imu, *driver.others.values()]
        spin_until(spinner, lambda: all(p.get_subscription_count() > 0 for p in ready), rounds=600)
        heard = driver.last

        def ticks(count):
            for _ in range(3):
                driver.publish()
            return len(driver.odometry) >= count

        spin_until(spinner, lambda: ticks(50), rounds=1500)
        assert driver.odometry[0].stamp - heard < 10**9
        counts = node.part.status()
        for name in ("dvl", "dvl_aft", "pressure", "pressure_aft"):
            assert counts[f"{name}_accepted"] > 6, counts
        driver.silent = {"dvl", "pressure"}
        spin_until(spinner, lambda: ticks(100), rounds=2000)
        assert np.abs(driver.errors(since=5)).max() < 3.0
        assert "no samples: dvl, pressure" in told(driver)
        later = node.part.status()
        assert later["dvl_accepted"] <= counts["dvl_accepted"] + 2  # what was on its way
        assert later["dvl_aft_accepted"] > counts["dvl_aft_accepted"] + 6
