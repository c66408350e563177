"""The 3-D picture: the ray caster against geometry, and what the picture shows of a run."""

import numpy as np
import pytest
from matplotlib.image import imread
from synthetic import Known, write_log

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.hull_chord import chord
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.report.arrows import SHORTEST, force_arrows
from uvms_analysis.report.posture import HULL, Posture, ball, body_shapes, rod
from uvms_analysis.report.raycast import Camera, Layer, blend, frame, render, shrink
from uvms_analysis.report.scene import SIZE, draw_scene
from uvms_core.vehicle import load_vehicle

RED, GREEN = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
LIGHT = np.array([0.0, 0.0, -1.0])
CAMERA = Camera(np.array([-10.0, 0.0, 0.0]), np.array([[0, 0, -1], [1, 0, 0], [0, -1, 0]]) * 1.0,
                1000.0, (400, 400))  # fmt: skip
"""Ten metres south of the origin, looking north: east is right, down is down."""


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "run.mcap"
    write_log(path, Known(duration=6.0, path_duration=4.0))
    return path


def seen(*shapes):
    return np.isfinite(render(shapes, CAMERA, LIGHT).depth)


def test_a_sphere_is_a_disc_of_its_apparent_radius():
    layer = render([ball(np.zeros(3), 1.0, RED)], CAMERA, LIGHT)
    apparent = 1000.0 * np.tan(np.arcsin(1.0 / 10.0))
    assert np.isfinite(layer.depth).sum() == pytest.approx(np.pi * apparent**2, rel=2e-3)
    assert layer.depth[200, 200] == pytest.approx(9.0, abs=1e-3)


def test_a_cylinder_across_is_a_rectangle_and_along_a_disc():
    across = seen(rod(np.array([0.0, -1.0, 0.0]), np.array([0.0, 1.0, 0.0]), 0.2, RED))
    rows, columns = np.nonzero(across)
    assert np.ptp(columns) + 1 == pytest.approx(200.0 / (1 - 0.02), abs=3)
    assert np.ptp(rows) + 1 == pytest.approx(2 * 1000.0 * np.tan(np.arcsin(0.02)), abs=2)
    along = seen(rod(np.array([-1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]), 0.5, RED))
    assert along.sum() == pytest.approx(np.pi * (1000.0 * 0.5 / 9.0) ** 2, rel=5e-3)


def test_a_cone_is_a_triangle_with_its_tip_at_the_end():
    rows, columns = np.nonzero(
        seen(rod(np.array([0.0, -1.0, 0.0]), np.array([0.0, 1.0, 0.0]), 0.4, RED, "cone"))
    )
    widths = np.array([np.sum(columns == column) for column in (110, 200, 290)])
    assert np.allclose(widths, [76.0, 40.0, 4.0], atol=2.5)
    assert np.abs(rows - 199.5).max() <= 41


def test_what_is_nearer_hides_what_is_behind():
    near, far = ball(np.array([-1.0, 0.0, 0.0]), 0.3, RED), ball(np.zeros(3), 1.0, GREEN)
    for shapes in ([near, far], [far, near]):
        colour = render(shapes, CAMERA, LIGHT).colour
        assert colour[200, 200].argmax() == 0
        assert colour[200, 260].argmax() == 1


def test_up_is_up_and_east_is_right_when_looking_north():
    high_east = np.array([[0.0, 1.0, -0.5]])
    x, y = CAMERA.project(high_east)[0]
    assert (x, y) == pytest.approx((300.0, 150.0))
    framed = frame([ball(np.zeros(3), 1.0, RED)], (180.0, 0.0), (400, 400))
    assert np.allclose(framed.R, CAMERA.R, atol=1e-12)


def test_the_lit_side_is_brighter():
    colour = render([ball(np.zeros(3), 1.0, RED)], CAMERA, LIGHT).colour
    assert colour[120, 200, 0] > 1.3 * colour[280, 200, 0]


@pytest.mark.parametrize("view", [(62.0, 14.0), (-120.0, 80.0), (0.0, -30.0)])
def test_a_framed_scene_fills_the_picture_and_nothing_is_cut_off(view):
    vehicle = load_vehicle()
    posture = Posture(0.0, (np.array([1.0, 2.0, 10.0]), np.eye(3)), np.array([0.2, 0.1, 1.4, 0.0]))
    shapes = body_shapes(vehicle, posture)
    there = np.isfinite(render(shapes, frame(shapes, view, (320, 200)), LIGHT).depth)
    rows, columns = np.nonzero(there)
    assert rows.min() >= 8
    assert rows.max() <= 191
    assert columns.min() >= 14
    assert columns.max() <= 305
    assert np.ptp(columns) > 270 or np.ptp(rows) > 165


def test_a_ghost_lets_the_background_through_and_never_covers_the_solid_layer():
    ghost = Layer(np.zeros((1, 2, 3)), np.array([[1.0, 1.0]]), opacity=0.25)
    solid = Layer(np.full((1, 2, 3), 0.5), np.array([[2.0, np.inf]]))
    image = blend([ghost, solid], np.ones((1, 2, 3)))
    assert np.allclose(image[0, 0], 0.5)
    assert np.allclose(image[0, 1], 0.75)
    assert np.allclose(shrink(np.tile(image, (2, 1, 1)), 2), 0.625)


def test_a_line_enters_and_leaves_the_hull_on_its_surface():
    hull = load_vehicle().hull
    place, along = np.array([0.55, 0.1, 0.0]), np.array([0.0, 0.0, 1.0])
    half = 0.5 * np.array([hull.spheroid.length_m, *2 * [hull.spheroid.diameter_m]])
    for distance in chord(hull, place, along):
        assert np.sum(((place + distance * along) / half) ** 2) == pytest.approx(1.0)
    assert chord(hull, np.array([0.0, 1.0, 0.0]), along) is None


@pytest.mark.parametrize("to_viewer", [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, -1.0]])
def test_arrows_stand_outside_the_hull_and_point_along_the_thrust(log, to_viewer):
    run = Analysis(RunLog.open(log))
    pose = np.array([1.0, 2.0, 10.0]), np.eye(3)
    posture = Posture(3.0, pose, np.zeros(4))
    found = force_arrows(run, posture, np.array(to_viewer))
    thrust = run.allocation.thrust[np.searchsorted(run.allocation.time, 3.0)]
    heads = [shape for shape in found.shapes if shape.kind == "cone"]
    shown = np.abs(thrust) > SHORTEST * np.abs(thrust).max()
    force = (run.disturbance.restoring + run.disturbance.coupling)[0, :3]
    assert len(heads) == shown.sum() + (np.linalg.norm(force) > SHORTEST * np.abs(thrust).max())
    pairs = zip(run.vehicle.thrusters, thrust, strict=True)
    expected = [np.sign(value) * np.array(item.direction) for item, value in pairs]
    for head, along in zip(heads, np.array(expected)[shown], strict=False):
        tip = head.axes[:, 2] / np.linalg.norm(head.axes[:, 2])
        np.testing.assert_allclose(tip, along, atol=1e-12)
        through = chord(run.vehicle.hull, head.centre - pose[0], tip)
        assert through is None or not through[0] < 0.0 < through[1]


def test_the_picture_shows_a_yellow_hull_on_a_light_background(log, tmp_path):
    picture = imread(draw_scene(log, tmp_path / "vehicle.png"))[..., :3]
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    hue = picture / picture.max(axis=2, keepdims=True)
    assert np.mean(np.abs(hue - np.array(HULL) / max(HULL)).max(axis=2) < 0.1) > 0.05
    assert picture[:40, :40].mean() > 0.95
    assert (tmp_path / "vehicle.png").stat().st_size < 400_000


@pytest.mark.parametrize("vehicle", ["bluerov2_alpha5", "reference_auv"])
def test_every_vehicle_has_shapes_around_its_own_place(vehicle):
    vehicle = load_vehicle(vehicle)
    position = np.array([3.0, -2.0, 20.0])
    shapes = body_shapes(
        vehicle, Posture(0.0, (position, np.eye(3)), np.zeros(len(vehicle.joint_names)))
    )
    count = 1 + len(vehicle.thruster_names) + 2 * len(vehicle.joint_names)
    assert len(shapes) >= count
    assert max(np.linalg.norm(shape.centre - position) for shape in shapes) < 2.5


def test_an_instant_outside_the_log_is_named_with_the_bounds(log, tmp_path):
    with pytest.raises(LogError, match=r"time 9 s lies outside the log .*: 0 to 6 s"):
        draw_scene(log, tmp_path / "vehicle.png", times_s=[1.0, 9.0])
    with pytest.raises(LogError, match="times_s is empty"):
        draw_scene(log, tmp_path / "vehicle.png", times_s=[])


@pytest.mark.parametrize("name", ["missing/vehicle.png", "vehicle.docx"])
def test_a_file_that_cannot_be_written_is_named(log, tmp_path, name):
    with pytest.raises(LogError, match="cannot be written"):
        draw_scene(log, tmp_path / name)


def test_a_log_without_poses_says_so(tmp_path):
    LogWriter(tmp_path / "run.mcap").close()
    with pytest.raises(LogError, match="ground_truth/odometry"):
        draw_scene(tmp_path / "run.mcap", tmp_path / "vehicle.png")
