"""What drivers publish, in their axes and frames, to signals in body axes and map_ned."""

from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest

from uvms_core.errors import SignalError, VehicleFileError
from uvms_core.messages import from_message, to_message
from uvms_core.rotations import quat_to_rpy, rpy_to_quat
from uvms_core.sensors import dvl, imu, mounted_sensors
from uvms_core.sensors.depth import DepthSample
from uvms_core.sensors.heading import HeadingSample
from uvms_core.sensors.magnetometer import MagneticSample
from uvms_core.sensors.position_fix import FixSample
from uvms_core.signals import DvlSample, GpsSample, ImuSample
from uvms_core.topics import of
from uvms_core.vehicle import load_vehicle

PLACE = {"rate_hz": 10.0, "position_m": [0.1, 0.0, 0.2]}
ADDED = {
    "environment.magnetic_field_ut": [17.0, 1.0, 45.0],
    "sensors.heading": {**PLACE, "noise_deg": 1.0},
    "sensors.magnetometer": {**PLACE, "noise_ut": 0.3},
    "sensors.depth": {**PLACE, "noise_m": 0.02},
    "sensors.position_fix": {**PLACE, "noise_m": 0.02},
}
ROTATED = {"rpy_deg": [10.0, -20.0, 135.0], "axes": "flu"}
IN_ENU = {**ROTATED, "world": "enu"}
COVARIANCE = np.array([[4.0, 1.0, 0.0], [1.0, 3.0, 0.5], [0.0, 0.5, 2.0]]) * 1e-4
TURN = rpy_to_quat(0.1, -0.2, 2.0)
G = 9.80665


def topic_of(name, **declared):
    """Topic of a sensor whose section says this on top."""
    section = load_vehicle(overrides=ADDED).sensors.mounted[name]
    whole = {**section.model_dump(exclude_unset=True), **declared}
    vehicle = load_vehicle(overrides={**ADDED, f"sensors.{name}": whole})
    return next(each.topic for each in mounted_sensors(vehicle) if each.name == name)


def as_object(value):
    """A nested dict as an object with attributes, as message classes are."""
    if isinstance(value, dict):
        return SimpleNamespace(**{name: as_object(each) for name, each in value.items()})
    return value


def as_message(topic, sample):
    return as_object(to_message(topic, sample))


def imu_message(topic, quaternion, force, rate=(0.0, 0.0, 0.0)):
    """What a driver publishes, not turned."""
    values = np.array(quaternion), np.array(rate), np.array(force)
    sample = ImuSample(5, *values, COVARIANCE, COVARIANCE, COVARIANCE)
    return as_object(imu.to_message(topic, sample, ()))


def test_rep_103_level_and_facing_north():
    """In east-north-up forward-left-up it is turned by 90 deg, and gravity is felt along +z."""
    topic = topic_of("imu", axes="flu", world="enu")
    half = np.sqrt(0.5)
    message = imu_message(topic, (0.0, 0.0, half, half), (0.0, 0.0, G), rate=(0.1, 0.2, 0.3))
    sample = from_message(topic, message)
    np.testing.assert_allclose(quat_to_rpy(sample.quaternion), 0.0, atol=1e-12)
    np.testing.assert_allclose(sample.linear_acceleration, [0.0, 0.0, -G])
    np.testing.assert_allclose(sample.angular_velocity, [0.1, -0.2, -0.3])


def test_a_dvl_that_is_mounted_across_reads_the_speed_ahead_along_its_port_axis():
    topic = topic_of("dvl", rpy_deg=[0.0, 0.0, 90.0])  # its x points to starboard
    ahead = DvlSample(5, np.array([1.0, 0.0, 0.2]), np.diag([1.0, 2.0, 3.0]))
    message = as_message(topic, ahead)
    velocity = message.twist.twist.linear
    np.testing.assert_allclose([velocity.x, velocity.y, velocity.z], [0.0, -1.0, 0.2], atol=1e-15)
    np.testing.assert_allclose(np.diag(message.twist.covariance.reshape(6, 6))[:3], [2, 1, 3])


SAMPLES = {
    "imu": ImuSample(
        7, TURN, np.array([0.1, 0.2, 0.3]), np.array([1.0, 2.0, -9.0]), *[COVARIANCE] * 3
    ),
    "dvl": DvlSample(7, np.array([0.5, -0.1, 0.05]), COVARIANCE),
    "heading": HeadingSample(7, TURN, COVARIANCE),
    "magnetometer": MagneticSample(7, np.array([1e-5, 2e-5, 4e-5]), COVARIANCE),
    "depth": DepthSample(7, 12.5, 1e-3),
    "position_fix": FixSample(7, np.array([10.0, -4.0, 12.0]), COVARIANCE),
}


@pytest.mark.parametrize("name", SAMPLES)
@pytest.mark.parametrize("declared", [{}, ROTATED, IN_ENU, {**IN_ENU, "frame_id": "sensor_7"}])
def test_what_is_published_as_declared_is_read_as_it_was(name, declared):
    if "world" in declared and name in ("dvl", "magnetometer"):
        declared = {key: value for key, value in declared.items() if key != "world"}
    topic, sample = topic_of(name, **declared), SAMPLES[name]
    message = as_message(topic, sample)
    assert message.header.frame_id == topic.frame == declared.get("frame_id", topic.frame)
    back = from_message(topic, message)
    for field in fields(sample):
        ours, theirs = getattr(back, field.name), getattr(sample, field.name)
        if isinstance(theirs, str | bool):
            assert ours == theirs
        else:
            sign = -1.0 if field.name == "quaternion" and np.dot(ours, theirs) < 0 else 1.0
            np.testing.assert_allclose(sign * ours, theirs, rtol=1e-9, atol=1e-15)


def test_nothing_is_turned_where_nothing_is_declared():
    vehicle = load_vehicle()
    for sensor in mounted_sensors(vehicle):
        assert sensor.topic == sensor.type.topic
        assert sensor.topic in of(vehicle)


def test_an_imu_without_orientation_says_so_and_may_have_any_quaternion():
    topic = topic_of("imu")
    sample = replace(SAMPLES["imu"], oriented=False, quaternion=np.array([0.0, 0.0, 0.0, 1.0]))
    message = as_message(topic, sample)
    assert message.orientation_covariance[0] == -1.0
    message.orientation.w = 0.0
    assert not from_message(topic, message).oriented
    undeclared = imu_message(topic_of("imu", orientation=False), TURN, (0.0, 0.0, -G))
    assert not from_message(topic_of("imu", orientation=False), undeclared).oriented


def test_an_imu_that_says_that_it_measures_no_acceleration_is_refused():
    topic = topic_of("imu")
    message = as_message(topic, SAMPLES["imu"])
    message.linear_acceleration_covariance = np.array([-1.0, *[0.0] * 8])
    with pytest.raises(SignalError, match=r"linear_acceleration_covariance\[0\] is -1"):
        from_message(topic, message)


@pytest.mark.parametrize("field", ["angular_velocity", "linear_acceleration"])
def test_a_covariance_that_is_not_finite_is_refused(field):
    topic = topic_of("imu")
    message = as_message(topic, SAMPLES["imu"])
    setattr(message, f"{field}_covariance", np.array([0.1, *[np.nan] * 8]))
    with pytest.raises(SignalError, match=rf"{field}_covariance.*nan"):
        from_message(topic, message)


def test_a_wrong_frame_id_names_the_field_that_changes_it():
    topic = topic_of("imu")
    message = as_message(replace(topic, frame="imu_link"), SAMPLES["imu"])
    with pytest.raises(SignalError, match=r"'imu_link'.*'imu_link_fsd'.*sensors\.imu\.frame_id"):
        from_message(topic, message)
    assert topic_of("imu", frame_id="imu_link").frame == "imu_link"
    assert topic_of("imu", axes="flu").frame == "imu_link"


def test_unknown_covariances_become_zeros():
    topic = topic_of("dvl")
    message = as_message(topic, SAMPLES["dvl"])
    message.twist.covariance[0] = -1.0
    assert not from_message(topic, message).covariance.any()
    topic = topic_of("gps")
    fix = GpsSample(7, True, 44.0, 8.0, 1.0, np.diag([1.0, 2.0, 3.0]))
    message = as_message(topic, fix)
    np.testing.assert_array_equal(from_message(topic, message).covariance, fix.covariance)
    message.position_covariance_type = 0
    assert not from_message(topic, message).covariance.any()


def test_the_marine_dvl_says_what_it_is_locked_to():
    topic = topic_of("dvl", message=dvl.MARINE, **ROTATED)
    assert topic.type == "marine_acoustic_msgs/msg/Dvl"
    for lock, mode in (("bottom", 1), ("water", 2)):
        message = as_message(topic, replace(SAMPLES["dvl"], lock=lock))
        assert message.velocity_mode == mode
        back = from_message(topic, message)
        assert back.lock == lock
        np.testing.assert_allclose(back.velocity, SAMPLES["dvl"].velocity)
    message.velocity_mode = 0
    with pytest.raises(SignalError, match="velocity_mode is 0"):
        from_message(topic, message)


def test_a_twist_is_locked_to_what_the_vehicle_file_says():
    topic = topic_of("dvl", lock="water")
    assert from_message(topic, as_message(topic, SAMPLES["dvl"])).lock == "water"


def test_a_depth_counts_down_whatever_its_frame():
    for declared, z in (({}, 12.5), ({"world": "enu"}, -12.5)):
        topic = topic_of("depth", **declared)
        assert as_message(topic, SAMPLES["depth"]).pose.pose.position.z == z


def test_a_topic_may_have_any_name():
    assert topic_of("imu", topic="/mavros/imu/data").resolve("auv") == "/mavros/imu/data"
    assert topic_of("imu", topic="ahrs/data").resolve("auv") == "/auv/ahrs/data"


def test_sensors_may_be_missing_and_there_may_be_two_of_a_kind():
    overrides = {"sensors.dvl": None, "sensors.gps": None, "sensors.pressure": None}
    vehicle = load_vehicle(overrides=overrides)
    assert [sensor.name for sensor in mounted_sensors(vehicle)] == ["imu"]
    second = {**PLACE, "type": "dvl", "noise_m_s": 0.01, "scale_error": 0.005}
    vehicle = load_vehicle(overrides={"sensors.dvl_aft": second})
    aft = mounted_sensors(vehicle)[-1]
    assert (aft.name, aft.type.name, aft.topic.name) == ("dvl_aft", "dvl", "sensors/dvl_aft")


@pytest.mark.parametrize(
    ("overrides", "text"),
    [
        ({"sensors.imu_2": "imu"}, "one inertial unit alone carries the estimate"),
        ({"sensors.magnetometer": {**PLACE, "noise_ut": 1.0}}, "environment.magnetic_field_ut"),
        ({"sensors.sonar": {**PLACE, "type": "echo"}}, "no installed package brings a sensor"),
        ({"sensors.imu.axes": "nwu"}, "axes"),
    ],
)
def test_a_vehicle_file_is_refused_with_a_reason(overrides, text):
    if overrides.get("sensors.imu_2"):
        unit = load_vehicle().sensors.imu.model_dump(exclude_unset=True)
        overrides = {"sensors.imu_2": {**unit, "type": "imu"}}
    with pytest.raises(VehicleFileError, match=text):
        load_vehicle(overrides=overrides)


def test_an_imu_without_orientation_needs_no_noise_of_it():
    unit = load_vehicle().sensors.imu.model_dump(exclude_unset=True)
    kept = {name: value for name, value in unit.items() if "heading" not in name}
    kept = {name: value for name, value in kept.items() if "roll" not in name}
    vehicle = load_vehicle(overrides={"sensors.imu": {**kept, "orientation": False}})
    assert vehicle.sensors.imu.heading_noise_deg == 0.0
    with pytest.raises(VehicleFileError, match="heading_noise_deg"):
        load_vehicle(overrides={"sensors.imu": kept})
