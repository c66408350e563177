"""Signals to messages and back: exact, checked, and clear about what is wrong."""

from dataclasses import fields, is_dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest
from examples import JOINTS, carrying, example, names_of

from uvms_core import topics
from uvms_core.errors import SignalError
from uvms_core.messages import from_message, to_message
from uvms_core.rotations import quat_to_matrix
from uvms_core.sensors.gps import swap_ned_enu
from uvms_core.signals import GpsSample, Odometry


def as_object(value):
    """A nested dict as an object with attributes, as rclpy and decoded logs have them."""
    if isinstance(value, dict):
        return SimpleNamespace(**{key: as_object(item) for key, item in value.items()})
    if isinstance(value, list):
        return [as_object(item) for item in value]
    return value


def assert_equal(one, two):
    if not is_dataclass(one):
        assert one == two
        return
    assert type(one) is type(two)
    for field in fields(one):
        a, b = getattr(one, field.name), getattr(two, field.name)
        if is_dataclass(a):
            assert_equal(a, b)
            continue
        np.testing.assert_array_equal(a, b, err_msg=field.name)
        assert np.shape(a) == np.shape(b)


def message(topic, rng, **changes):
    """A random message of a topic as an object, with dotted fields changed."""
    msg = as_object(to_message(topic, example(topic.signal, rng), names_of(topic)))
    for path, value in changes.items():
        *parents, last = path.split("__")
        target = msg
        for part in parents:
            target = getattr(target, part)
        setattr(target, last, value)
    return msg


@pytest.fixture
def rng():
    return np.random.default_rng(5)


@pytest.mark.parametrize("topic", [*carrying(), *topics.ACTIONS], ids=lambda t: t.name)
def test_every_signal_comes_back_exactly(topic, rng):
    kind = topic.goal if topic in topics.ACTIONS else topic.signal
    for _ in range(5):
        signal = example(kind, rng)
        back = from_message(topic, as_object(to_message(topic, signal, names_of(topic))))
        assert_equal(back, signal)


def test_arrays_of_a_signal_are_its_own(rng):
    msg = message(topics.ODOMETRY, rng)
    odometry = from_message(topics.ODOMETRY, msg)
    msg.pose.covariance[0] = 99.0
    assert odometry.pose_covariance[0, 0] != 99.0


def test_stamps_are_exact_to_the_nanosecond():
    for stamp in (0, 1, 999_999_999, 1_000_000_001, (2**31 - 1) * 10**9 + 7):
        msg = to_message(topics.CLOCK, stamp)
        assert 0 <= msg["clock"]["nanosec"] < 10**9
        assert from_message(topics.CLOCK, as_object(msg)) == stamp


def test_values_by_name_are_brought_into_order(rng):
    msg = message(topics.JOINT_STATES, rng)
    msg.name = list(reversed(msg.name))
    given = np.array(msg.position)
    np.testing.assert_array_equal(
        from_message(topics.JOINT_STATES, msg, JOINTS).position, given[::-1]
    )
    np.testing.assert_array_equal(from_message(topics.JOINT_STATES, msg).position, given)


def test_reference_columns_are_brought_into_order(rng):
    msg = message(topics.REFERENCE, rng)
    straight = from_message(topics.REFERENCE, msg, JOINTS)
    msg.joint_names = list(reversed(msg.joint_names))
    turned = from_message(topics.REFERENCE, msg, JOINTS)
    np.testing.assert_array_equal(turned.q, straight.q[:, ::-1])
    np.testing.assert_array_equal(turned.q_ddot, straight.q_ddot[:, ::-1])
    assert turned.q.flags["C_CONTIGUOUS"]


def test_gps_covariance_is_east_north_up_in_the_message():
    ned = np.array([[1.0, 2.0, 3.0], [2.0, 4.0, 5.0], [3.0, 5.0, 6.0]])
    turn = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    np.testing.assert_array_equal(swap_ned_enu(ned), turn @ ned @ turn.T)
    np.testing.assert_array_equal(swap_ned_enu(swap_ned_enu(ned)), ned)


def test_gps_without_fix_may_be_nan(rng):
    nan = float("nan")
    sample = GpsSample(5, False, nan, nan, nan, np.eye(3))
    back = from_message(topics.GPS, as_object(to_message(topics.GPS, sample)))
    assert not back.fix
    assert np.isnan(back.latitude_deg)


def test_unmeasured_rates_of_the_dvl_are_marked(rng):
    covariance = np.reshape(message(topics.DVL, rng).twist.covariance, (6, 6))
    np.testing.assert_array_equal(np.diag(covariance)[3:], [-1.0, -1.0, -1.0])


def test_huge_but_finite_numbers_pass(rng):
    msg = message(
        topics.ODOMETRY, rng, pose__pose__position__x=1e308, pose__pose__position__y=1e308
    )
    assert from_message(topics.ODOMETRY, msg).position[0] == 1e308


NAN, INF = float("nan"), float("inf")
FAULTS = [
    (
        topics.ODOMETRY,
        {"header__frame_id": "map"},
        "odometry: header.frame_id is 'map'; it must be 'map_ned'",
    ),
    (
        topics.ODOMETRY,
        {"child_frame_id": ""},
        "odometry: child_frame_id is ''; it must be 'base_link_fsd'",
    ),
    (
        topics.ODOMETRY,
        {"pose__pose__position__y": NAN},
        "odometry: pose.pose.position.y is nan; it must be finite",
    ),
    (
        topics.ODOMETRY,
        {"pose__pose__orientation__w": INF},
        "odometry: pose.pose.orientation.w is inf; it must be finite",
    ),
    (
        topics.ODOMETRY,
        {"pose__pose__orientation": SimpleNamespace(x=0.0, y=0.0, z=0.0, w=0.5)},
        "odometry: pose.pose.orientation has length 0.5; it must be 1",
    ),
    (
        topics.ODOMETRY,
        {"pose__covariance": np.array([0.0] * 7 + [INF] + [0.0] * 28)},
        "odometry: pose.covariance[7] is inf; it must be finite",
    ),
    (
        topics.WRENCH_COMMAND,
        {"wrench__torque__z": -INF},
        "wrench_command: wrench.torque.z is -inf; it must be finite",
    ),
    (
        topics.THRUSTER_COMMAND,
        {"effort": [1.0, 2.0]},
        "thruster_command: effort has 2 values; it must have 7",
    ),
    (
        topics.JOINT_STATES,
        {"velocity": []},
        "joint_states: velocity has 0 values; it must have 4",
    ),
    (
        topics.JOINT_COMMAND,
        {"name": ["swing", "shoulder", "elbow", "hand"]},
        "joint_command: name is swing, shoulder, elbow, hand; "
        "it must name swing, shoulder, elbow, wrist",
    ),
    (
        topics.ALLOCATION,
        {"saturated": [True]},
        "allocation: saturated has 1 values; it must have 7",
    ),
    (topics.GPS, {"latitude": NAN}, "sensors/gps: latitude is nan; it must be finite"),
    (
        topics.PRESSURE,
        {"fluid_pressure": INF},
        "sensors/pressure: fluid_pressure is inf; it must be finite",
    ),
    (
        topics.IMU,
        {"linear_acceleration__x": NAN},
        "sensors/imu: linear_acceleration.x is nan; it must be finite",
    ),
    (topics.REFERENCE, {"points": []}, "reference: points is empty; it must have at least one"),
    (
        topics.DIAGNOSTICS,
        {"status": []},
        "/diagnostics: status has 0 values; it must have 1",
    ),
]


@pytest.mark.parametrize(("topic", "changes", "text"), FAULTS, ids=lambda v: str(v)[:40])
def test_what_is_wrong_is_named(topic, changes, text, rng):
    with pytest.raises(SignalError) as fault:
        from_message(topic, message(topic, rng, **changes), names_of(topic))
    assert str(fault.value) == text


def test_times_of_a_reference_increase_from_zero(rng):
    msg = message(topics.REFERENCE, rng)
    msg.points[3].time_from_start.nanosec = 0
    with pytest.raises(SignalError) as fault:
        from_message(topics.REFERENCE, msg)
    assert str(fault.value) == (
        "reference: points[3].time_from_start is 0 s, after 0.1 s; times must increase"
    )
    del msg.points[0]
    msg.points = msg.points[:2]
    with pytest.raises(SignalError, match=r"points\[0\].time_from_start is 0.05 s; it must be 0"):
        from_message(topics.REFERENCE, msg)


def test_a_reference_need_not_say_what_disturbance_is_planned(rng):
    msg = message(topics.REFERENCE, rng)
    msg.points[1].disturbance = []
    with pytest.raises(SignalError) as fault:
        from_message(topics.REFERENCE, msg)
    assert str(fault.value) == (
        "reference: points[1].disturbance has 0 values; other points have one, so it must have one"
    )
    for point in msg.points:
        point.disturbance = []
    assert from_message(topics.REFERENCE, msg).disturbance is None
    for point in msg.points:  # as in a log from before this field
        del point.disturbance
    assert from_message(topics.REFERENCE, msg).disturbance is None


def test_faults_inside_a_point_are_named(rng):
    msg = message(topics.REFERENCE, rng)
    msg.points[2].joint_velocity[1] = NAN
    with pytest.raises(SignalError) as fault:
        from_message(topics.REFERENCE, msg)
    assert str(fault.value) == "reference: points[2].joint_velocity[1] is nan; it must be finite"


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda m: m.positions.clear(), "positions is empty; it must have at least one"),
        (lambda m: m.orientations.pop(), "orientations has 2 values; it must have 0 or 3"),
        (lambda m: m.time_from_start.pop(), "time_from_start has 2 values; it must have 3"),
        (lambda m: setattr(m.positions[1], "z", NAN), "positions[1].z is nan; it must be finite"),
        (
            lambda m: setattr(m.header, "frame_id", "odom"),
            "header.frame_id is 'odom'; it must be 'map_ned' or 'map'",
        ),
        (
            lambda m: setattr(m, "max_time_scale", 0.5),
            "max_time_scale is 0.5; it must be >= 1, or 0",
        ),
        (lambda m: setattr(m.tool_axis, "x", 1.0), "axis_directions has 0 values; it must have 3"),
    ],
)
def test_a_wrong_path_is_refused(change, text, rng):
    action = topics.FOLLOW_END_EFFECTOR_PATH
    msg = as_object(to_message(action, example(action.goal, rng)))
    change(msg)
    with pytest.raises(SignalError) as fault:
        from_message(action, msg)
    assert str(fault.value) == f"follow_end_effector_path: {text}"


def test_a_path_in_map_is_the_same_path_in_map_ned(rng):
    """East, north, up become north, east, down, for positions, orientations and directions."""
    action = topics.FOLLOW_END_EFFECTOR_PATH
    goal = example(action.goal, rng)
    msg = as_object(to_message(action, goal))
    msg.header.frame_id = "map"
    turned = from_message(action, msg)
    east, north, up = goal.positions.T
    np.testing.assert_array_equal(turned.positions, np.column_stack([north, east, -up]))
    for before, after in zip(goal.orientations, turned.orientations, strict=True):
        x, y, z = quat_to_matrix(before)
        np.testing.assert_allclose(quat_to_matrix(after), [y, x, -z], atol=1e-12)


def test_a_tool_axis_and_its_directions_are_made_unit_vectors(rng):
    action = topics.FOLLOW_END_EFFECTOR_PATH
    plain = example(action.goal, rng)
    rows = np.array([[0.0, 0.0, 2.0], [0.0, 3.0, 4.0], [1.0, 0.0, 0.0]])
    goal = replace(
        plain,
        orientations=np.empty((0, 4)),
        tool_axis=np.array([0.0, 0.0, 5.0]),
        axis_directions=rows,
        time_scale_max=3.0,
    )
    msg = as_object(to_message(action, goal))
    back = from_message(action, msg)
    np.testing.assert_allclose(back.tool_axis, [0.0, 0.0, 1.0])
    np.testing.assert_allclose(back.axis_directions, [[0, 0, 1], [0, 0.6, 0.8], [1, 0, 0]])
    assert back.time_scale_max == 3.0
    msg.header.frame_id = "map"
    np.testing.assert_allclose(
        from_message(action, msg).axis_directions, [[0, 0, -1], [0.6, 0, -0.8], [0, 1, 0]]
    )


def test_topics_without_a_signal_say_so():
    with pytest.raises(SignalError, match="robot_description: carries no signal"):
        to_message(topics.ROBOT_DESCRIPTION, "")


def test_tf_holds_the_pose_of_the_vehicle(rng):
    odometry = example(Odometry, rng)
    transform = to_message(topics.TF, odometry)["transforms"][0]
    assert transform["header"]["frame_id"] == "map_ned"
    assert transform["child_frame_id"] == "base_link_fsd"
    assert list(transform["transform"]["translation"].values()) == odometry.position.tolist()


def pose_message(rng, **changes):
    action = topics.GO_TO_POSE
    msg = as_object(to_message(action, example(action.goal, rng)))
    msg.header.frame_id = changes.pop("frame", "map_ned")
    for path, value in changes.items():
        *parents, last = path.split("__")
        target = msg
        for part in parents:
            target = getattr(target, part)
        setattr(target, last, value)
    return msg


def test_a_pose_in_map_is_that_of_base_link(rng):
    """East of north by 30 deg is 60 deg from east; forward is forward in both bodies."""
    half = np.deg2rad(60.0) / 2
    turned = SimpleNamespace(x=0.0, y=0.0, z=np.sin(half), w=np.cos(half))
    point = SimpleNamespace(x=1.0, y=2.0, z=-3.0)  # east, north, up
    msg = pose_message(rng, frame="map", pose__orientation=turned, pose__position=point)
    goal = from_message(topics.GO_TO_POSE, msg)
    np.testing.assert_array_equal(goal.position, [2.0, 1.0, 3.0])
    expected = [0.0, 0.0, np.sin(np.deg2rad(15.0)), np.cos(np.deg2rad(15.0))]
    np.testing.assert_allclose(np.abs(goal.quaternion @ expected), 1.0, atol=1e-15)
    np.testing.assert_allclose(
        quat_to_matrix(goal.quaternion), quat_to_matrix(np.array(expected)), atol=1e-15
    )


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"frame": "odom"}, "go_to_pose: header.frame_id is 'odom'; it must be 'map_ned' or 'map'"),
        ({"pose__position__x": NAN}, "go_to_pose: pose.position.x is nan; it must be finite"),
        ({"pose__orientation__w": 9.0}, "go_to_pose: pose.orientation has length"),
        ({"max_speed": -0.5}, "go_to_pose: max_speed is -0.5; it must be >= 0"),
        ({"max_speed": INF}, "go_to_pose: max_speed is inf; it must be finite"),
        ({"duration__sec": -3}, "go_to_pose: duration is -2.5; it must be >= 0"),
        ({"hold__sec": -1}, "go_to_pose: hold is -1; it must be >= 0"),
    ],
)
def test_a_pose_that_is_not_right_is_refused_by_field_and_value(rng, change, text):
    with pytest.raises(SignalError, match=text):
        from_message(topics.GO_TO_POSE, pose_message(rng, **change))


def test_each_goal_has_its_action(rng):
    for action in topics.ACTIONS:
        assert topics.action_of(example(action.goal, rng)) is action
