"""Clearances against coal, an independent library of collisions, and in closed form."""

import coal
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numba.core.runtime import _nrt_python, rtsys
from random_vehicles import random_vehicle

from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.scene import Obstacle
from uvms_core.vehicle import Vehicle, joint_limits, load_vehicle
from uvms_core.vehicle.frames import arm_frames
from uvms_core.vehicle.outline import (
    CapsuleOutline,
    SpheroidOutline,
    box_outline,
    hull_outlines,
    link_outlines,
)
from uvms_dynamics.geometry import (
    HULL_NAME,
    build_geometry,
    clearances,
    clearances_along,
    clearances_of_poses,
)

SEABED_M = 4.0
TOLERANCE = 2e-6  # that of coal's own iterations on curved shapes is 1e-6

# ---- coal


def turned(rotation, position):
    return coal.Transform3s(np.asarray(rotation), np.asarray(position, dtype=float))


def coal_outline(outline):
    """A shape of coal and its pose in the body's frame."""
    if isinstance(outline, SpheroidOutline):
        return coal.Ellipsoid(outline.along, outline.across, outline.across), turned(
            np.eye(3), [0] * 3
        )
    if not isinstance(outline, CapsuleOutline):
        return coal.Box(*(2.0 * outline.half)), turned(outline.rotation, outline.centre)
    span = outline.end - outline.start
    length = np.linalg.norm(span)
    if length == 0.0:
        return coal.Sphere(outline.radius), turned(np.eye(3), outline.start)
    z = span / length
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    rotation = np.column_stack([x, np.cross(z, x), z])
    return coal.Capsule(outline.radius, length), turned(
        rotation, 0.5 * (outline.start + outline.end)
    )


def coal_obstacle(obstacle):
    if obstacle.box is not None:
        return coal_outline(box_outline(obstacle.box))
    centre = np.array(obstacle.sphere.center_m)
    return coal_outline(CapsuleOutline(centre, centre, obstacle.sphere.radius_m))


class Judge:
    """Least distance of two bodies by coal, each given as shapes with poses."""

    def __init__(self):
        self.request, self.result = coal.DistanceRequest(), coal.DistanceResult()
        self.request.gjk_tolerance = 1e-10
        self.request.epa_tolerance = 1e-8
        self.request.gjk_max_iterations = 1000
        self.request.epa_max_iterations = 1000

    def distance(self, ones, others):
        return min(self._pair(*one, *other) for one in ones for other in others)

    def _pair(self, shape, pose, other, other_pose):
        self.result.clear()
        return coal.distance(shape, pose, other, other_pose, self.request, self.result)


def placed_bodies(vehicle, position, rotation, q):
    """Shapes of hull and links by name, in map_ned, from the vehicle file's own frames."""
    body = turned(rotation, position)
    bodies = {HULL_NAME: [coal_outline(each) for each in hull_outlines(vehicle.hull)]}
    for number, (origin, axes) in enumerate(arm_frames(vehicle.arm, q)[1:]):
        shapes = map(coal_outline, link_outlines(vehicle.arm, number))
        frame = turned(axes, origin)
        bodies[vehicle.arm.links[number].name] = [(s, frame * pose) for s, pose in shapes]
    return {
        name: [(shape, body * pose) for shape, pose in shapes] for name, shapes in bodies.items()
    }


# ---- random scenes


def random_box(rng, spread, least=0.05, most=0.8):
    return {
        "center_m": rng.uniform(-spread, spread, 3).tolist(),
        "size_m": rng.uniform(least, most, 3).tolist(),
        "rpy_deg": rng.uniform(-180.0, 180.0, 3).tolist(),
    }


def random_obstacles(rng):
    for number in range(2):
        yield Obstacle(name=f"box {number}", box=random_box(rng, 1.5))
        ball = {"center_m": rng.uniform(-1.5, 1.5, 3).tolist(), "radius_m": rng.uniform(0.02, 0.5)}
        yield Obstacle(name=f"ball {number}", sphere=ball)


def random_capsules(rng):
    for _ in range(rng.integers(1, 3)):
        start = rng.uniform(-0.3, 0.3, 3)
        yield {
            "start_m": start.tolist(),
            "end_m": (start + rng.choice([0.0, 0.4, 1.0]) * rng.normal(size=3)).tolist(),
            "radius_m": rng.uniform(0.01, 0.1),
        }


def random_shapes(seed, hull):
    """A vehicle of three joints with its hull as boxes, as a spheroid or as its inertia says."""
    rng = np.random.default_rng(seed)
    data = random_vehicle(seed, 3).model_dump(mode="json")
    if hull == "boxes":
        data["hull"]["boxes"] = [random_box(rng, 0.5) for _ in range(2)]
    elif hull == "spheroid":
        length = rng.uniform(0.3, 2.5)
        data["hull"]["spheroid"] = {
            "length_m": length,
            "diameter_m": rng.uniform(0.1, 0.99) * length,
        }
    for link in data["arm"]["links"]:
        link["capsules"] = list(random_capsules(rng))
    data["environment"]["seabed_depth_m"] = SEABED_M
    return Vehicle.model_validate(data)  # of any size


def random_poses(rng, vehicle, count):
    quaternions = rng.normal(size=(count, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    angles = rng.uniform(*joint_limits(vehicle), (count, vehicle.n_joints))
    return rng.uniform(-1.5, 1.5, (count, 3)), quaternions, angles


@pytest.mark.parametrize("hull", ["spheroid", "boxes", "inertia"])
@pytest.mark.parametrize("seed", range(12))
def test_against_coal(hull, seed):
    """Outside one another exactly; overlapping, negative and no deeper than what parts them."""
    rng = np.random.default_rng([seed, len(hull)])
    vehicle = random_shapes(seed, hull)
    obstacles = tuple(random_obstacles(rng))
    geometry, judge = build_geometry(vehicle, obstacles), Judge()
    scene = {each.name: [coal_obstacle(each)] for each in obstacles}
    scene["seabed"] = [
        (coal.Halfspace(np.array([0.0, 0.0, -1.0]), -SEABED_M), turned(np.eye(3), [0] * 3))
    ]
    poses = random_poses(rng, vehicle, 25)
    ours = clearances_of_poses(geometry, *poses)
    outside = 0
    for position, quaternion, q, row in zip(*poses, ours, strict=True):
        bodies = placed_bodies(vehicle, position, quat_to_matrix(quaternion), q) | scene
        for pair, value in zip(geometry.pairs, row, strict=True):
            theirs = judge.distance(bodies[pair.body], bodies[pair.other])
            if theirs > TOLERANCE or pair.kind == "seabed":
                assert value == pytest.approx(theirs, abs=TOLERANCE), (pair, theirs)
                outside += 1
            else:
                assert theirs - TOLERANCE <= value <= TOLERANCE, (pair, theirs)
    assert outside > 100


# ---- closed forms


def level(vehicle, position, yaw=0.0, q=None):
    q = np.radians(vehicle.arm.stowed_deg) if q is None else q
    return np.array([*position, yaw, *q])


def named(geometry, values):
    return {
        (pair.body, pair.other): value for pair, value in zip(geometry.pairs, values, strict=True)
    }


def ball(name, center, radius):
    return Obstacle(name=name, sphere={"center_m": list(center), "radius_m": radius})


def without_fins(**environment):
    data = load_vehicle().model_dump(mode="json")
    data["hull"]["fins"] = []
    data["environment"] |= environment
    return Vehicle.model_validate(data)


def test_spheroid_above_the_seabed():
    """Upright or flat an ellipsoid reaches down by its half axis; tilted by t in between."""
    geometry = build_geometry(without_fins(seabed_depth_m=20.0))
    tilts = np.radians([0.0, 30.0, 90.0])
    quaternions = np.array([rpy_to_quat(0.3, tilt, 1.0) for tilt in tilts])
    poses = np.tile([5.0, 6.0, 15.0], (3, 1)), quaternions, np.zeros((3, 4))
    reach = np.sqrt((1.2 * np.sin(tilts)) ** 2 + (0.19 * np.cos(tilts)) ** 2)
    index = [str(pair) for pair in geometry.pairs].index("hull and seabed")
    assert clearances_of_poses(geometry, *poses)[:, index] == pytest.approx(5.0 - reach, abs=1e-12)


def test_balls_on_the_axes_of_a_spheroid():
    """Ahead of the bow, abeam, and at the centre, where the nearest way out is across."""
    obstacles = (
        ball("bow", (2.0, 0, 10), 0.3),
        ball("beam", (0, 1.0, 10), 0.3),
        ball("in", (0, 0, 10), 0.1),
    )
    vehicle = without_fins()
    geometry = build_geometry(vehicle, obstacles)
    values = named(geometry, clearances(geometry, level(vehicle, (0, 0, 10))))
    assert values["hull", "bow"] == pytest.approx(2.0 - 1.2 - 0.3, abs=1e-12)
    assert values["hull", "beam"] == pytest.approx(1.0 - 0.19 - 0.3, abs=1e-12)
    assert values["hull", "in"] == pytest.approx(-0.19 - 0.1, abs=1e-12)


def test_points_off_a_spheroid():
    """A point at the distance s along the normal of a spheroid's surface is s away from it."""
    vehicle = without_fins()
    angle = np.linspace(0.0, np.pi, 9)
    surface = np.column_stack([1.2 * np.cos(angle), 0.19 * np.sin(angle), 0.0 * angle])
    normal = surface / np.array([1.2, 0.19, 1.0]) ** 2
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    for s in (-0.02, 0.001, 0.4, 30.0):  # the surface's least radius of curvature is 0.03 m
        centres = surface + s * normal + [0.0, 0.0, 10.0]
        obstacles = [ball(f"{k}", each, 1e-9) for k, each in enumerate(centres)]
        geometry = build_geometry(vehicle, obstacles)
        values = named(geometry, clearances(geometry, level(vehicle, (0, 0, 10))))
        assert [values["hull", each.name] for each in obstacles] == pytest.approx([s] * 9, abs=2e-9)


def test_a_fin_counts():
    """The reference vehicle's lower rudder reaches 0.21 + 0.105 m below the axis."""
    vehicle = load_vehicle()
    geometry = build_geometry(vehicle, [ball("below", (-1.0, 0.0, 11.0), 0.1)])
    values = named(geometry, clearances(geometry, level(vehicle, (0, 0, 10))))
    assert values["hull", "below"] == pytest.approx(1.0 - 0.315 - 0.1, abs=1e-12)


# ---- properties

unit = st.floats(0.0, 1.0)


@pytest.fixture(scope="module")
def around():
    """The reference vehicle among obstacles, with its seabed."""
    data = load_vehicle().model_dump(mode="json")
    data["environment"]["seabed_depth_m"] = 12.0
    obstacles = [
        ball("ball", (1.5, 0.5, 10.5), 0.3),
        Obstacle(
            name="box", box={"center_m": [0, 1, 10], "size_m": [1, 0.5, 2], "rpy_deg": [9, 8, 7]}
        ),
    ]
    vehicle = Vehicle.model_validate(data)
    return vehicle, build_geometry(vehicle, obstacles)


def configuration(vehicle, shares):
    low, high = joint_limits(vehicle)
    low = np.concatenate([[-2, -2, 8, -np.pi], low])
    return low + np.array(shares) * (np.concatenate([[2, 2, 12, np.pi], high]) - low)


@given(
    shares=st.lists(unit, min_size=8, max_size=8),
    step=st.lists(st.floats(-1, 1), min_size=3, max_size=3),
)
def test_moving_by_a_distance_changes_no_clearance_by_more(around, shares, step):
    vehicle, geometry = around
    c = configuration(vehicle, shares)
    moved = c + np.array([*step, 0, 0, 0, 0, 0])
    change = np.abs(clearances(geometry, moved) - clearances(geometry, c))
    assert change.max() <= np.linalg.norm(step) + 1e-12


@given(shares=st.lists(unit, min_size=8, max_size=8))
def test_finite_differences_agree(around, shares):
    """Smooth to rounding: central differences of 1e-4 and 1e-6 agree but at kinks.

    At a kink, where what is nearest changes, the left and right ones differ instead.
    """
    vehicle, geometry = around
    c = configuration(vehicle, shares)
    for k, axis in enumerate(np.eye(8)):
        steps = np.array([0.0, -1e-4, 1e-4, -1e-6, 1e-6])
        at, *sides = clearances_along(geometry, c + steps[:, None] * axis)
        wide, fine = (sides[1] - sides[0]) / 2e-4, (sides[3] - sides[2]) / 2e-6
        bend = np.abs(sides[0] + sides[1] - 2.0 * at) / 1e-4
        assert (np.abs(wide - fine) <= bend + 1e-6).all(), k


@given(shares=st.lists(unit, min_size=8, max_size=8))
def test_the_place_does_not_matter_to_the_arm(around, shares):
    vehicle, geometry = around
    own = [pair.kind in ("hull", "arm") for pair in geometry.pairs]
    c = configuration(vehicle, shares)
    there = c * [0, 0, 0, 0, 1, 1, 1, 1]
    assert clearances(geometry, c)[own] == pytest.approx(
        clearances(geometry, there)[own], abs=1e-12
    )


def test_level_and_any_attitude_agree(around):
    vehicle, geometry = around
    rng = np.random.default_rng(3)
    rows = np.array([configuration(vehicle, rng.uniform(size=8)) for _ in range(50)])
    turns = np.array([rpy_to_quat(0.0, 0.0, yaw) for yaw in rows[:, 3]])
    of_poses = clearances_of_poses(geometry, rows[:, :3].copy(), turns, rows[:, 4:].copy())
    assert of_poses == pytest.approx(clearances_along(geometry, rows), abs=1e-12)


@pytest.fixture
def allocations():
    """Counts what compiled code allocates in a call."""
    _nrt_python.memsys_enable_stats()

    def count(function, *arguments):
        before = rtsys.get_allocation_stats().alloc
        function(*arguments)
        return rtsys.get_allocation_stats().alloc - before

    yield count
    _nrt_python.memsys_disable_stats()


def test_nothing_is_allocated_along_a_path(around, allocations):
    vehicle, geometry = around
    rows = np.tile(configuration(vehicle, [0.5] * 8), (500, 1))
    clearances_along(geometry, rows)
    one = allocations(clearances_along, geometry, rows[:1])
    assert allocations(clearances_along, geometry, rows) == one > 0


# ---- which pairs count, and shapes by rule


def test_wrong_sizes_are_refused(around):
    _, geometry = around
    with pytest.raises(ValueError, match="one angle for each joint"):
        clearances(geometry, np.zeros(7))
    poses = np.zeros((2, 3)), np.zeros((1, 4)), np.zeros((2, 4))
    with pytest.raises(ValueError, match="as many positions as quaternions"):
        clearances_of_poses(geometry, *poses)
