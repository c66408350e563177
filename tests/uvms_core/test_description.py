"""URDF and transforms of a vehicle against Pinocchio and our own kinematics."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pinocchio as pin
import pytest
from random_vehicles import REFERENCE, random_motion, random_vehicle
from urdf_chains import as_urdf, real_vehicle

from uvms_core import topics
from uvms_core.description import StateFrames, static_message, tree, urdf_text
from uvms_core.description.solids import spheroid_solids
from uvms_core.description.urdf import matrix_to_rpy
from uvms_core.errors import VehicleFileError
from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.signals import JointStates, Odometry
from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import build_model, end_effector, inverse_dynamics

VEHICLES = {
    "reference": REFERENCE,
    "1 joint": random_vehicle(21, 1, water=False),
    "4 joints": random_vehicle(22, 4, water=False),
    "7 joints": random_vehicle(23, 7, water=False),
    "4 joints as URDF": as_urdf(random_vehicle(24, 4, water=False)),
    "real": real_vehicle(),
}
STAMP = 12_345_678_901


@pytest.fixture(params=VEHICLES)
def vehicle(request):
    return VEHICLES[request.param]


def engine(vehicle):
    """The URDF as Pinocchio reads it, on a free flyer; world z down."""
    model = pin.buildModelFromXML(urdf_text(vehicle), pin.JointModelFreeFlyer())
    model.gravity.linear = np.array([0.0, 0.0, vehicle.environment.gravity_m_s2])
    return model


def state(vehicle, seed=3):
    """A random pose and joint angles."""
    rng = np.random.default_rng(seed)
    quat = rng.normal(size=4)
    q = rng.uniform(-3.0, 3.0, vehicle.n_joints)
    return rng.normal(size=3), quat / np.linalg.norm(quat), q


def signals_of(position, quat, q):
    none = np.zeros(len(q))
    odometry = Odometry(STAMP, position, quat, np.zeros(6), np.eye(6), np.eye(6))
    return odometry, JointStates(STAMP, q, none, none)


def pose_of(transform):
    """4x4 matrix of a TransformStamped in a plain dict."""
    matrix = np.eye(4)
    turn = [transform["transform"]["rotation"][axis] for axis in "xyzw"]
    matrix[:3, :3] = quat_to_matrix(np.array(turn))
    matrix[:3, 3] = [transform["transform"]["translation"][axis] for axis in "xyz"]
    return matrix


def lookup(vehicle, odometry, joints):
    """Every frame's pose in `map`, as a viewer puts the transforms together."""
    moving = StateFrames(vehicle).message(odometry, joints)["transforms"]
    waiting = [*static_message(vehicle)["transforms"], *moving]
    poses = {"map": np.eye(4)}
    while waiting:
        ready = [t for t in waiting if t["header"]["frame_id"] in poses]
        assert ready, "frames that hang on nothing"
        for transform in ready:
            parent = poses[transform["header"]["frame_id"]]
            assert transform["child_frame_id"] not in poses, "a frame with two parents"
            poses[transform["child_frame_id"]] = parent @ pose_of(transform)
        waiting = [t for t in waiting if t not in ready]
    return poses


def test_the_urdf_has_the_kinematics_of_the_vehicle_file(vehicle):
    model, ours = engine(vehicle), build_model(vehicle)
    data, tool = model.createData(), model.getFrameId("tool")
    for seed in range(20):
        position, quat, q = state(vehicle, seed)
        pin.framesForwardKinematics(model, data, np.concatenate([position, quat, q]))
        expected_position, expected_rotation = end_effector(ours, position, quat, q)
        np.testing.assert_allclose(data.oMf[tool].translation, expected_position, atol=1e-12)
        np.testing.assert_allclose(data.oMf[tool].rotation, expected_rotation, atol=1e-12)


def test_the_urdf_has_the_limits_and_friction_of_the_vehicle_file(vehicle):
    model = engine(vehicle)
    joints = vehicle.arm.joints
    assert list(model.names)[2:] == list(vehicle.joint_names)
    degrees = {
        "lower_deg": model.lowerPositionLimit[7:],
        "upper_deg": model.upperPositionLimit[7:],
        "rate_limit_deg_s": model.velocityLimit[6:],
    }
    for field, found in degrees.items():
        expected = np.radians([getattr(joint, field) for joint in joints])
        np.testing.assert_allclose(found, expected, rtol=1e-14, err_msg=field)
    assert model.effortLimit[6:].tolist() == [joint.effort_limit_nm for joint in joints]
    assert model.damping[6:].tolist() == [joint.viscous_friction_nm_s for joint in joints]


@pytest.mark.parametrize("name", ["1 joint", "4 joints", "7 joints"])
def test_the_urdf_has_the_inertias_of_the_vehicle_file(name):
    """Inverse dynamics of the dry vehicle; what URDF has no word for is the rotors' inertia."""
    vehicle = VEHICLES[name]
    model = engine(vehicle)
    model.armature[6:] = [joint.rotor_inertia_kg_m2 for joint in vehicle.arm.joints]
    motion = random_motion(np.random.default_rng(5), vehicle.n_joints)
    expected = pin.rnea(
        model,
        model.createData(),
        np.concatenate([[1.0, -2.0, 3.0], motion.quat, motion.q]),
        np.concatenate([motion.nu, motion.q_dot]),
        np.concatenate([motion.nu_dot, motion.q_ddot]),
    )
    found = inverse_dynamics(build_model(vehicle), *motion)
    np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-10 * np.abs(expected).max())


def test_the_urdf_has_every_sensor_and_thruster_where_it_is(vehicle):
    model = engine(vehicle)
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))

    def placed(frame):
        assert model.existFrame(frame), frame
        return data.oMf[model.getFrameId(frame)]

    sensors = vehicle.sensors
    for name, sensor in (
        ("imu_link_fsd", sensors.imu),
        ("dvl_link_fsd", sensors.dvl),
        ("pressure_link_fsd", sensors.pressure),
        ("gps_link_fsd", sensors.gps),
    ):
        np.testing.assert_allclose(placed(name).translation, sensor.position_m, atol=1e-15)
        np.testing.assert_allclose(placed(name).rotation, np.eye(3), atol=1e-15)
    for thruster in vehicle.thrusters:
        pose = placed(f"thruster_{thruster.name}")
        np.testing.assert_allclose(pose.translation, thruster.position_m, atol=1e-15)
        np.testing.assert_allclose(pose.rotation[:, 0], thruster.direction, atol=1e-12)


def test_the_cylinders_stand_where_the_links_are():
    """At the CG, the axis along the link's: of the reference vehicle's homogeneous links."""
    model = engine(REFERENCE)
    visuals = pin.buildGeomFromUrdfString(model, urdf_text(REFERENCE), pin.GeometryType.VISUAL)
    by_name = {item.name: item for item in visuals.geometryObjects}
    for number, link in enumerate(REFERENCE.arm.links):
        shape = by_name[f"{link.name}_0"]
        inertia = model.inertias[number + 2]
        axis = shape.placement.rotation[:, 2]
        radius, length = link.cylinder.radius_m, link.cylinder.length_m
        assert (shape.geometry.radius, 2.0 * shape.geometry.halfLength) == (radius, length)
        np.testing.assert_allclose(shape.placement.translation, inertia.lever, atol=1e-12)
        # Along its axis a cylinder has m r^2 / 2.
        along = axis @ inertia.inertia @ axis
        assert along == pytest.approx(0.5 * link.mass_kg * radius**2, rel=1e-9)


def test_the_hull_is_its_spheroid():
    """The spheres touch the spheroid from inside, and leave no dent above 3 % of its radius."""
    shape = REFERENCE.hull.spheroid
    a, b = shape.length_m / 2.0, shape.diameter_m / 2.0
    solids = spheroid_solids(shape)
    x = np.linspace(-0.999 * a, 0.999 * a, 2001)
    spheres = [s.radius**2 - (x - s.pose[0][0]) ** 2 for s in solids]
    outline = np.sqrt(np.clip(spheres, 0.0, None)).max(axis=0)
    exact = b * np.sqrt(1.0 - (x / a) ** 2)
    assert (outline - exact).max() < 1e-12
    assert (exact - outline).max() < 0.03 * b
    assert max(s.pose[0][0] + s.radius for s in solids) == pytest.approx(a)


def test_a_hull_without_a_shape_is_seen_all_the_same():
    text = urdf_text(VEHICLES["4 joints"])
    spheres = ElementTree.fromstring(text).findall("link[@name='hull']/visual/geometry/sphere")
    (radius,) = (float(sphere.get("radius")) for sphere in spheres)
    assert 4.0 / 3.0 * np.pi * radius**3 == pytest.approx(VEHICLES["4 joints"].hull.volume_m3)


def test_the_root_is_the_body_frame_and_has_no_mass(vehicle):
    robot = ElementTree.fromstring(urdf_text(vehicle))
    children = {joint.find("child").get("link") for joint in robot.findall("joint")}
    links = [link.get("name") for link in robot.findall("link")]
    assert [name for name in links if name not in children] == ["base_link_fsd"]
    assert len(set(links)) == len(links) == len(children) + 1
    assert robot.find("link[@name='base_link_fsd']/inertial") is None


@pytest.mark.parametrize("pitch", [0.3, np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-9, -1.57])
def test_angles_give_the_rotation_back_at_any_pitch(pitch):
    for roll, yaw in np.random.default_rng(1).uniform(-np.pi, np.pi, (50, 2)):
        matrix = quat_to_matrix(rpy_to_quat(roll, pitch, yaw))
        again = quat_to_matrix(rpy_to_quat(*matrix_to_rpy(matrix)))
        np.testing.assert_allclose(again, matrix, atol=4e-15)


def test_marine_frames_are_joined_to_the_usual_ones():
    static = {t["child_frame_id"]: t for t in static_message(REFERENCE, STAMP)["transforms"]}
    world, body = static["map_ned"], static["base_link"]
    assert (world["header"]["frame_id"], body["header"]["frame_id"]) == ("map", "base_link_fsd")
    assert world["header"]["stamp"] == {"sec": 12, "nanosec": 345_678_901}
    north, east, down = pose_of(world)[:3, :3].T
    np.testing.assert_allclose(north, [0.0, 1.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(east, [1.0, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(down, [0.0, 0.0, -1.0], atol=1e-15)
    forward, left, up = pose_of(body)[:3, :3].T
    np.testing.assert_allclose(forward, [1.0, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(left, [0.0, -1.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(up, [0.0, 0.0, -1.0], atol=1e-15)


def test_a_vehicle_on_its_way_is_upright_in_the_map():
    """Heading east, 10 m deep: in the map x is ahead, and base_link's z is up."""
    quat = rpy_to_quat(0.0, 0.0, np.pi / 2)
    odometry, joints = signals_of(np.array([2.0, 3.0, 10.0]), quat, np.zeros(4))
    base = lookup(REFERENCE, odometry, joints)["base_link"]
    np.testing.assert_allclose(base[:3, 3], [3.0, 2.0, -10.0], atol=1e-12)
    np.testing.assert_allclose(base[:3, :3], np.eye(3), atol=1e-12)


def test_the_transforms_put_the_tool_where_it_is(vehicle):
    world = static_message(vehicle)["transforms"][0]
    for seed in range(10):
        position, quat, q = state(vehicle, seed)
        tool = lookup(vehicle, *signals_of(position, quat, q))["tool"]
        expected = np.eye(4)
        expected[:3, 3], expected[:3, :3] = end_effector(build_model(vehicle), position, quat, q)
        np.testing.assert_allclose(tool, pose_of(world) @ expected, atol=1e-12)


def test_the_transforms_place_every_link_of_the_urdf(vehicle):
    """A viewer needs one transform for each link, or it shows the link at the wrong place."""
    model = engine(vehicle)
    data = model.createData()
    position, quat, q = state(vehicle)
    poses = lookup(vehicle, *signals_of(position, quat, q))
    pin.framesForwardKinematics(model, data, np.concatenate([position, quat, q]))
    robot = ElementTree.fromstring(urdf_text(vehicle))
    for link in (element.get("name") for element in robot.findall("link")):
        expected = poses["map_ned"] @ data.oMf[model.getFrameId(link)].homogeneous
        np.testing.assert_allclose(poses[link], expected, atol=1e-12, err_msg=link)


def test_moving_transforms_have_the_stamp_of_the_odometry(vehicle):
    odometry, joints = signals_of(*state(vehicle))
    transforms = StateFrames(vehicle).message(odometry, joints)["transforms"]
    assert len(transforms) == 1 + vehicle.n_joints
    assert [t["header"]["stamp"] for t in transforms] == [
        {"sec": 12, "nanosec": 345_678_901}
    ] * len(transforms)
    first = transforms[0]
    assert (first["header"]["frame_id"], first["child_frame_id"]) == (
        topics.WORLD_FRAME,
        topics.BODY_FRAME,
    )


@pytest.mark.parametrize(
    ("name", "what"), [("tool", "frames"), ("map", "frames"), ("thruster_main", "frames")]
)
def test_a_link_that_takes_another_frames_name_is_refused(name, what):
    data = REFERENCE.model_dump(mode="json")
    data["arm"]["links"][1]["name"] = name
    with pytest.raises(VehicleFileError, match=f"two {what} named {name}; rename the link"):
        tree(vehicle_from_data(data))


def test_a_joint_that_takes_another_joints_name_is_refused():
    data = REFERENCE.model_dump(mode="json")
    data["arm"]["joints"][1]["name"] = "tool_mount"
    with pytest.raises(VehicleFileError, match="two joints named tool_mount; rename"):
        urdf_text(vehicle_from_data(data))


def test_names_are_escaped():
    data = REFERENCE.model_dump(mode="json") | {"name": 'a<b>&"c"'}
    robot = ElementTree.fromstring(urdf_text(vehicle_from_data(data)))
    assert robot.get("name") == 'a<b>&"c"'
