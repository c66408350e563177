"""Joint angles by posture, by joint name and in order; how far an arm reaches."""

import numpy as np
import pytest
from random_vehicles import REFERENCE, random_vehicle

from uvms_core.errors import ConfigError, VehicleFileError
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.frames import arm_frames, arm_length, compose, joint_frames, mounting_pose
from uvms_core.vehicle.postures import joint_angles_deg


@pytest.mark.parametrize(
    ("angles", "expected"),
    [
        ("stowed", (0.0, 0.0, 135.0, 0.0)),
        ("home", (0.0, 10.0, 115.0, 0.0)),
        ((1.0, 2.0, 3.0, 4.0), (1.0, 2.0, 3.0, 4.0)),
        ({"wrist": 7.0}, (0.0, 0.0, 135.0, 7.0)),
        ({}, (0.0, 0.0, 135.0, 0.0)),
    ],
)
def test_every_way_to_give_joint_angles(angles, expected):
    assert joint_angles_deg(REFERENCE.arm, angles) == expected


def test_joints_that_are_left_out_may_be_as_in_another_pose():
    assert joint_angles_deg(REFERENCE.arm, {"wrist": 7.0}, (1, 2, 3, 4)) == (1, 2, 3, 7.0)


@pytest.mark.parametrize(
    ("angles", "text"),
    [
        ("folded", "the vehicle has no posture 'folded'; choose one of stowed, home, "),
        ({"knee": 1.0}, "there is no joint 'knee'; the joints are swing, shoulder, elbow, wrist"),
        ((1.0,), "has 1 values for 4 joints: swing, shoulder, elbow, wrist"),
    ],
)
def test_what_the_arm_does_not_have_is_named(angles, text):
    with pytest.raises(ConfigError) as fault:
        joint_angles_deg(REFERENCE.arm, angles)
    assert str(fault.value).startswith(text)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ({"up": [0.0]}, "postures_deg.up: has 1 values for 4 joints: swing, shoulder,"),
        ({"up": {"knee": 1.0}}, "postures_deg.up: there is no joint 'knee'"),
        ({"up": {"elbow": 141.0}}, "postures_deg.up: 141 of joint elbow is outside its limits"),
        ({"stowed": [0, 0, 0, 0]}, "postures_deg.stowed: give that posture as stowed_deg"),
    ],
)
def test_a_posture_that_does_not_fit_the_arm_is_refused(value, text):
    with pytest.raises(VehicleFileError) as fault:
        load_vehicle(overrides={"arm.postures_deg": value})
    assert text in str(fault.value)


@pytest.mark.parametrize(
    "vehicle", [REFERENCE, load_vehicle("bluerov2_alpha5"), random_vehicle(5, 7)]
)
def test_the_tool_is_never_farther_from_the_first_joint_than_the_arm_is_long(vehicle):
    rng = np.random.default_rng(1)
    limit = arm_length(vehicle.arm)
    distances = []
    for q in rng.uniform(-np.pi, np.pi, (500, vehicle.n_joints)):
        tool, _ = compose(arm_frames(vehicle.arm, q)[-1], mounting_pose(vehicle.arm.tool))
        distances.append(np.linalg.norm(tool - joint_frames(vehicle.arm, q)[0][0]))
    assert 0.4 * limit < max(distances) <= limit


def test_a_stretched_planar_arm_is_as_long_as_its_links():
    changes = {"arm.joints.swing.d_m": 0.0}  # 0.08 + 0.46 + 0.38 + 0.18
    assert arm_length(load_vehicle(overrides=changes).arm) == pytest.approx(1.10)
