"""The loop flies with every error of every sensor at once, mild ones, and with real drives."""

import numpy as np

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario

MILD = {
    "imu.latency_s": 0.01,
    "imu.drop_out_rate": 0.01,
    "imu.outlier_rate": 1e-3,
    "imu.attitude_outlier_deg": 0.5,
    "imu.gyro_outlier_deg_s": 1.0,
    "imu.accelerometer_outlier_m_s2": 0.5,
    "imu.misalignment_deg": 0.2,
    "imu.attitude_random_walk_deg": 0.005,
    "imu.attitude_resolution_deg": 0.01,
    "imu.gyro_random_walk_deg_s": 1e-3,
    "imu.gyro_scale_error": 1e-3,
    "imu.gyro_resolution_deg_s": 0.01,
    "imu.accelerometer_random_walk_m_s2": 1e-4,
    "imu.accelerometer_scale_error": 1e-3,
    "imu.accelerometer_resolution_m_s2": 1e-3,
    "dvl.latency_s": 0.1,
    "dvl.drop_out_rate": 0.05,
    "dvl.outlier_rate": 0.01,
    "dvl.outlier_m_s": 0.3,
    "dvl.bias_m_s": 2e-3,
    "dvl.random_walk_m_s": 1e-4,
    "dvl.misalignment_deg": 0.3,
    "dvl.resolution_m_s": 1e-3,
    "dvl.min_altitude_m": 0.3,
    "dvl.max_altitude_m": 50.0,
    "dvl.max_tilt_deg": 30.0,
    "pressure.latency_s": 0.05,
    "pressure.drop_out_rate": 0.02,
    "pressure.outlier_rate": 0.01,
    "pressure.outlier_pa": 1000.0,
    "pressure.random_walk_pa": 5.0,
    "pressure.scale_error": 1e-4,
    "pressure.resolution_pa": 20.0,
    "gps.horizontal_bias_m": 1.0,
    "gps.vertical_bias_m": 1.0,
    "gps.horizontal_random_walk_m": 0.05,
    "gps.vertical_random_walk_m": 0.05,
    "gps.resolution_m": 0.1,
    "gps.outlier_rate": 0.01,
    "gps.outlier_m": 5.0,
    "gps.latency_s": 0.2,
    "gps.drop_out_rate": 0.1,
    "encoders.bias_deg": 0.05,
    "encoders.outlier_rate": 1e-3,
    "encoders.outlier_deg": 0.3,
}


def test_hover_with_all_errors_of_all_sensors():
    settings = [f"vehicle.sensors.{path}={value}" for path, value in MILD.items()]
    settings += ["vehicle.environment.seabed_depth_m=40.0"]
    scenario = load_scenario("hover", settings, vehicle="bluerov2_alpha5")
    loop = Loop(scenario, scenario.load_vehicle())
    tick, off = loop.tick(), []
    while tick.stamp < 20_000_000_000:
        loop.advance(tick)
        tick = loop.tick()
        truth = tick.truth.odometry
        off.append(np.linalg.norm(tick.odometry.position - truth.position))
    status = {each.name: each.values for each in loop.final_status(tick)}
    navigation = status["navigation"]
    assert navigation["samples_late"] > 100
    assert navigation["samples_refused"] == 0
    assert 0.9 * 160 * 0.95 < navigation["dvl_accepted"] + navigation["dvl_gated"] < 160
    assert max(off) < 0.5
    assert np.linalg.norm(truth.position - np.array(scenario.plant.initial_position_m)) < 0.5
    assert sum(values.get("unsafe_outputs", 0) for values in status.values()) == 0
