"""What the simulated camera sees, and where it sees nothing."""

from types import SimpleNamespace as Message

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uvms_core.errors import VehicleFileError
from uvms_core.sensors import sensor_type
from uvms_core.sensors.target_marker import MarkerSample, from_message, to_message
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.simulation.sensors.mounting import Trajectory
from uvms_dynamics.simulation.sensors.target_marker import TargetMarkerSensor

MARKER = {
    "rate_hz": 5.0,
    "position_m": [0.9, -0.1, 0.15],
    "rpy_deg": [0.0, -90.0, 0.0],
    "field_of_view_deg": [60.0, 40.0],
    "min_range_m": 0.3,
    "max_range_m": 3.0,
    "max_view_angle_deg": 70.0,
    "noise_m": 0.003,
    "angle_noise_deg": 1.0,
    "target_position_m": [0.9, -0.1, 11.65],
}
TOPIC = sensor_type("target_marker").topic


def sights(count=1, position=(0.0, 0.0, 10.0), rpy_deg=(0.0, 0.0, 0.0), seed=1, **changes):
    """Samples of a vehicle that rests there, one each 0.2 s."""
    vehicle = load_vehicle(overrides={"sensors.target_marker": MARKER | changes})
    section = vehicle.sensors.mounted["target_marker"]
    sensor = TargetMarkerSensor(vehicle, section, 200_000_000, seed)
    yaw_pitch_roll = rpy_deg[::-1]
    quaternion = Rotation.from_euler("ZYX", yaw_pitch_roll, degrees=True).as_quat()
    state = np.concatenate([position, quaternion, np.zeros(6)])
    states = np.tile(state, (count, 1))
    stamps = tuple(200_000_000 * k for k in range(count))
    return sensor, sensor.sample(Trajectory(stamps, states, np.zeros_like(states), np.zeros(3)))


def test_the_marker_is_seen_where_it_is_in_the_cameras_axes():
    """1.5 m straight below a camera that looks down: along z, and its normal against z."""
    _, samples = sights(400)
    places = np.array([sample.position for sample in samples])
    np.testing.assert_allclose(places.mean(axis=0), [0.0, 0.0, 1.5], atol=1e-3)
    np.testing.assert_allclose(places.std(axis=0), 0.003, rtol=0.15)
    turns = Rotation.from_quat([sample.quaternion for sample in samples])
    normal = turns.mean().apply([0.0, 0.0, 1.0])
    np.testing.assert_allclose(normal, [0.0, 0.0, -1.0], atol=2e-3)
    off = (turns * turns.mean().inv()).as_rotvec(degrees=True)
    np.testing.assert_allclose(off.std(axis=0), 1.0, rtol=0.15)


def test_a_vehicle_that_moves_and_turns_sees_it_elsewhere():
    """Forward of the marker, it is aft in the picture, which is down: y is down in the image."""
    _, (sample,) = sights(position=(0.3, 0.2, 10.0))
    np.testing.assert_allclose(sample.position, [-0.2, 0.3, 1.5], atol=0.015)


@pytest.mark.parametrize(
    "hidden",
    [
        {"position": (0.0, 0.0, 8.0)},  # out of range
        {"position": (0.0, 0.0, 11.3)},  # too near
        {"position": (0.0, 0.9, 10.0)},  # beside the picture
        {"position": (0.6, 0.0, 10.0)},  # below it
        {"rpy_deg": (0.0, 40.0, 0.0)},  # the camera looks elsewhere
        {"position": (0.0, 0.0, 13.0)},  # it is behind the camera
        {"target_rpy_deg": [0.0, 0.0, 0.0]},  # it faces away
        {"target_rpy_deg": [105.0, 0.0, 0.0]},  # it is seen from the side
    ],
)
def test_it_is_not_seen(hidden):
    assert sights(**hidden)[1] == ()


def test_where_the_place_is_known_with_a_std_the_true_one_is_drawn_from_it():
    off = [
        sights(0, seed=seed, target_std_m=0.05, target_std_deg=2.0)[0].place
        - MARKER["target_position_m"]
        for seed in range(60)
    ]
    np.testing.assert_allclose(np.std(off), 0.05, rtol=0.25)
    np.testing.assert_array_equal(sights(0)[0].place, MARKER["target_position_m"])


def test_a_message_is_read_as_it_was_written():
    place, turned = np.array([0.1, 0.2, 1.4]), np.array([1.0, 0.0, 0.0, 0.0])
    sample = MarkerSample(1_500_000_000, place, turned, np.eye(6))
    plain = to_message(TOPIC, sample, ())
    pose = plain["pose"]["pose"]
    xyz = Message(**pose["position"])
    xyzw = Message(**pose["orientation"])
    message = Message(
        header=Message(stamp=Message(**plain["header"]["stamp"]), frame_id="target_marker_optical"),
        pose=Message(
            pose=Message(position=xyz, orientation=xyzw), covariance=plain["pose"]["covariance"]
        ),
    )
    read = from_message(TOPIC, message, ())
    for name in ("stamp", "position", "quaternion", "covariance"):
        np.testing.assert_array_equal(getattr(read, name), getattr(sample, name))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"max_range_m": 0.2}, "max_range_m = 0.2 m must be above min_range_m = 0.3 m"),
        ({"field_of_view_deg": [190.0, 40.0]}, "must lie between 0 and 180"),
    ],
)
def test_a_camera_that_could_see_nothing_is_refused(change, text):
    with pytest.raises(VehicleFileError, match=text):
        load_vehicle(overrides={"sensors.target_marker": MARKER | change})
