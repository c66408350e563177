"""Late, lost and faulty samples on the real graph: lockstep waits for none and equals the process.

The inertial unit is the hard case, since its samples start the ticks.
"""

import numpy as np
from graph import column, finished, uvms_here

from uvms_core import topics

ERRORS = {
    "imu.latency_s": 0.02,
    "imu.drop_out_rate": 0.2,
    "imu.outlier_rate": 0.01,
    "imu.gyro_outlier_deg_s": 1.0,
    "dvl.latency_s": 0.12,
    "dvl.drop_out_rate": 0.3,
    "dvl.max_tilt_deg": 30.0,
    "pressure.drop_out_rate": 0.5,
    "gps.latency_s": 0.2,
}
SAME = (
    (topics.IMU, "angular_velocity"),
    (topics.DVL, "velocity"),
    (topics.ODOMETRY, "position"),
    (topics.TRUE_ODOMETRY, "position"),
    (topics.THRUSTER_COMMAND, "thrust"),
)


def test_the_graph_goes_on_without_the_samples_that_do_not_come(tmp_path):
    arguments = ["hover", "--vehicle", "bluerov2_alpha5", "--duration", "4", "--seed", "3"]
    for path, value in ERRORS.items():
        arguments += ["--set", f"vehicle.sensors.{path}={value}"]
    graph = finished(uvms_here(tmp_path, "run", *arguments, "--composed"))
    alone = finished(uvms_here(tmp_path / "alone", "simulate", *arguments))
    assert graph.summary["completed"] is True
    assert graph.summary["lockstep_timeouts"] == 0
    assert len(graph.log.series(topics.ODOMETRY)) == 81
    assert len(graph.log.series(topics.IMU)) < 0.9 * 401
    for topic, name in SAME:
        ours, theirs = (column(each.log, topic, name) for each in (graph, alone))
        assert ours.shape == theirs.shape, topic.name
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9, err_msg=topic.name)
