"""The scene: what stands where at a time of a run, against the log and closed forms."""

import numpy as np
import pytest
from viewed import short_run

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.instants import Instants
from uvms_bringup.scenario import load_scenario
from uvms_bringup.viewer.batches import batches
from uvms_bringup.viewer.cameras import PRESETS, view_of
from uvms_bringup.viewer.describe import describe
from uvms_bringup.viewer.elements import Place, is_shown, parent, world_pose
from uvms_bringup.viewer.log_source import WANTED, LogSource
from uvms_bringup.viewer.meshes import unit_mesh
from uvms_bringup.viewer.moment import Forces, Moment, Posture, Thrusts
from uvms_bringup.viewer.player import Player
from uvms_bringup.viewer.pushes import FULL, IDLE
from uvms_bringup.viewer.scene_model import SceneModel, Setting
from uvms_bringup.viewer.tool_paths import PIECES, blocks, cover
from uvms_bringup.viewer.uncertainty import SIGMAS
from uvms_core import topics
from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle import load_vehicle

VEHICLES = ("reference_auv", "bluerov2_alpha5")


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    return LogSource(short_run(tmp_path_factory.mktemp("view") / "run"))


@pytest.fixture(scope="module")
def model(source):
    return SceneModel(source.setting)


def level(vehicle, **more):
    """A vehicle at rest, level, heading north at 10 m."""
    posture = Posture(np.array([1.0, 2.0, 10.0]), np.array([0.0, 0.0, 0.0, 1.0]),
                      np.zeros(vehicle.n_joints))  # fmt: skip
    return Moment(0.0, true=posture, estimated=posture, **more)


def test_the_tool_stands_where_the_log_has_it(source, model):
    run = Analysis(source.log)
    estimated = run.estimated_end_effector
    for row in range(0, len(run.truth), 20):
        places = model.all_places(source.moment(float(run.truth.time[row])))
        true = world_pose(model.true.tool, places)[0]
        assert np.abs(true - run.end_effector[row]).max() < 1e-6
        solid = world_pose(model.estimated.tool, places)[0]
        assert np.abs(solid - estimated.position[row]).max() < 1e-6


def test_a_moment_is_the_newest_of_the_log_at_or_before_it(source):
    run = Analysis(source.log)
    between = 0.5 * float(run.truth.time[40] + run.truth.time[41])
    assert np.array_equal(source.moment(between).true.position, run.truth.position[40])
    instants = Instants(source.log, WANTED)
    for stamp in run.truth.stamps[[90, 3, 60]]:  # not in order
        said = instants.at(int(stamp))
        assert said[topics.TRUE_ODOMETRY.name].stamp == stamp
        assert said[topics.REFERENCE.name].stamp <= stamp < said[topics.REFERENCE.name].end + 1
    assert instants.at(-1) == {}
    late = instants.at(instants.last + to_nanoseconds(1.5))
    assert set(late) <= {topics.REFERENCE.name}  # all others are too old by then


@pytest.mark.parametrize("name", VEHICLES)
def test_up_is_up_port_is_red_and_starboard_green(name):
    vehicle = load_vehicle(name)
    model = SceneModel(Setting(vehicle))
    places = model.all_places(level(vehicle))
    lights = {side: model.nodes[f"estimated/light_{side}"] for side in ("port", "starboard")}
    at = {side: world_pose(light.name, places)[0] for side, light in lights.items()}
    assert at["port"][1] < 2.0 < at["starboard"][1]  # heading north, port is west
    red, green, _ = lights["port"].look.colour
    assert red > 0.8 > 0.2 > green
    red, green, _ = lights["starboard"].look.colour
    assert green > 0.7 > 0.2 > red
    for preset in PRESETS[:-1]:
        view = view_of(preset, model, places)
        assert view.position[2] < view.look_at[2]  # from above: z is down
    bow = view_of("chase", model, places)
    assert bow.position[0] < bow.look_at[0]  # from behind


def test_a_rolled_and_turned_body_carries_everything_along():
    vehicle = load_vehicle("reference_auv")
    model = SceneModel(Setting(vehicle))
    turn = rpy_to_quat(0.3, -0.2, 2.0)
    there = Posture(np.array([5.0, -3.0, 7.0]), turn, np.array([0.1, 0.2, 0.3, 0.4]))
    moved = model.all_places(Moment(0.0, true=there, estimated=there))
    still = model.all_places(level(vehicle))
    for item in vehicle.thrusters:
        place, R = world_pose(f"estimated/thruster_{item.name}", moved)
        expected = there.position + quat_to_matrix(turn) @ np.array(item.position_m)
        assert np.allclose(place, expected, atol=1e-12)
        assert np.allclose(R[:, 2], quat_to_matrix(turn) @ np.array(item.direction), atol=1e-12)
    port = world_pose("estimated/light_port", still)[0] - [1.0, 2.0, 10.0]
    turned = world_pose("estimated/light_port", moved)[0] - there.position
    assert np.allclose(quat_to_matrix(turn) @ port, turned, atol=1e-12)


def test_arrows_have_the_direction_and_the_length_of_their_force():
    vehicle = load_vehicle("reference_auv")
    model = SceneModel(Setting(vehicle, force_scale_n=50.0))
    force = np.array([0.0, -20.0, 10.0])
    thrust = np.array([0.5 * (-1) ** n * item.ahead_n for n, item in enumerate(vehicle.thrusters)])
    saturated = np.zeros(len(thrust), dtype=bool)
    saturated[1] = True
    moment = level(
        vehicle,
        thrusts=Thrusts(thrust, saturated, np.zeros(len(thrust))),
        forces=Forces(np.zeros(3), 1e-9 * force, force),
    )
    places = model.all_places(moment)
    assert not is_shown("estimated/force_restoring", places)
    assert not is_shown("estimated/force_coupling", places)
    external = places["estimated/force_external"]
    along = quat_to_matrix(external.quaternion)[:, 2]
    assert np.allclose(along * external.size[2] * 50.0 / model.pushes.longest, force, atol=1e-9)
    for number, item in enumerate(vehicle.thrusters):
        arrow = places[f"estimated/thrust_{item.name}"]
        sign = np.sign(thrust[number])
        along = quat_to_matrix(arrow.quaternion)[:, 2]
        assert np.allclose(along, sign * np.array(item.direction), atol=1e-12)
        half = tuple(0.5 * (a + b) for a, b in zip(IDLE, FULL, strict=True))
        assert arrow.colour == pytest.approx(FULL if number == 1 else half)


def test_the_ellipsoids_have_the_axes_of_the_covariance():
    """Of the tool, with an error in heading alone: the lever arm times it, across the lever."""
    vehicle = load_vehicle("reference_auv")
    model = SceneModel(Setting(vehicle))
    covariance = np.diag([4e-4, 1e-4, 9e-4, 0.0, 0.0, 0.0])
    places = model.all_places(level(vehicle, covariance=covariance))
    sizes = sorted(places["error_vehicle"].size)
    assert sizes == pytest.approx([0.01 * SIGMAS, 0.02 * SIGMAS, 0.03 * SIGMAS])
    heading = np.diag([0.0, 0.0, 0.0, 0.0, 0.0, 1e-4])
    places = model.all_places(level(vehicle, covariance=heading))
    assert not is_shown("error_vehicle", places)
    tool = world_pose("estimated/tool", places)[0] - [1.0, 2.0, 10.0]
    error = places["error_tool"]
    longest = int(np.argmax(error.size))
    assert error.size[longest] == pytest.approx(0.01 * SIGMAS * np.hypot(tool[0], tool[1]))
    across = quat_to_matrix(error.quaternion)[:, longest]
    assert abs(across @ tool) < 1e-9


def test_the_world_of_the_run_is_there(source, model):
    places = model.all_places(source.moment(5.0))
    seabed = places["seabed"]
    assert seabed.position[2] - seabed.size[2] == pytest.approx(14.0)
    rock = places["obstacle_rock"]
    assert rock.position.tolist() == [4.0, 1.0, 11.0]
    assert rock.size.tolist() == [0.6] * 3
    tether = places["tether"].points
    assert tether[-1][2] == 0.0
    assert np.allclose(tether[0], places["estimated"].position)
    flow = quat_to_matrix(places["current"].quaternion)[:, 2]
    assert np.allclose(flow, np.array([2.0, 1.0, 0.0]) / np.sqrt(5.0))


def test_the_tool_leaves_its_path_behind_and_has_its_target_ahead(source, model):
    early, late = (model.all_places(source.moment(time)) for time in (2.0, 7.5))
    for places, time in ((early, 2.0), (late, 7.5)):
        names = sorted(name for name in model.nodes if name.startswith("travelled_"))
        shown = [places[name].points for name in names if is_shown(name, places)]
        assert len(shown) <= np.log2(PIECES)
        way = np.concatenate([*shown[:1], *(line[1:] for line in shown[1:])])
        over = source.overview
        assert np.array_equal(way, over.tool[: len(way)])
        assert 0.0 <= time - over.times[len(way) - 1] < 1.2 * source.end_s / PIECES
    tool = world_pose(model.true.tool, late)[0]
    assert np.linalg.norm(late["target"].position - tool) < 0.05
    plan = late["planned_path"].points
    assert np.linalg.norm(plan[0] - late["target"].position) < 0.01
    assert is_shown("asked_path", late)


def test_any_number_of_pieces_is_few_lines_which_are_all_there():
    there = set(blocks(PIECES))
    for passed in range(PIECES + 1):
        lines = list(cover(passed))
        assert len(lines) == passed.bit_count()
        assert set(lines) <= there
        assert [n for first, end in lines for n in range(first, end)] == list(range(passed))


def test_propellers_turn_with_their_thrust_and_the_same_way_at_every_visit(source):
    first, again = source.moment(6.0).thrusts, source.moment(6.0).thrusts
    assert np.array_equal(first.turned, again.turned)
    over = source.overview
    limits = np.array([item.greatest_n for item in source.vehicle.thrusters])
    rates = 2.0 * np.pi * over.thrust / limits
    turned = np.trapezoid(rates, over.times, axis=0)
    assert np.allclose(source.moment(source.end_s).thrusts.turned, turned, atol=1e-6)


def test_the_run_ends_with_the_last_pose_and_not_with_the_plan_beyond_it(source):
    assert (source.start_s, source.end_s) == (0.0, 8.0)


def test_events_of_the_run_are_known(source):
    assert [at for at, _ in source.events] == pytest.approx([3.0, 4.0], abs=0.06)
    at_push = source.moment(3.5).forces.external
    before = source.moment(2.5).forces.external
    assert np.linalg.norm(at_push - before) == pytest.approx(20.0, rel=0.05)


def test_every_node_has_its_parent_before_it(model):
    seen = {""}
    for name in model.nodes:
        assert parent(name) in seen
        seen.add(name)


@pytest.mark.parametrize("kind", ["sphere", "cylinder", "cone", "box", "arrow"])
def test_meshes_are_closed_and_face_outward(kind):
    """The volume within, by the divergence theorem, is that of the solid and positive."""
    vertices, faces = unit_mesh(kind)
    a, b, c = (vertices[faces[:, n]] for n in range(3))
    volume = np.sum(a * np.cross(b, c)) / 6.0
    arrow = np.pi * (0.4**2 * 0.72 + 0.28 / 3.0)
    expected = {"sphere": 4.0 / 3.0 * np.pi, "cylinder": 2.0 * np.pi, "cone": 2.0 / 3.0 * np.pi,
                "box": 8.0, "arrow": arrow}[kind]  # fmt: skip
    assert volume == pytest.approx(expected, rel=0.03)


def test_the_player_keeps_within_the_run():
    player = Player(0.0, 10.0, 0.0, speed=2.0)
    player.advance(1.0)
    assert player.time == 0.0
    player.toggle()
    player.advance(1.5)
    assert player.time == 3.0
    player.advance(60.0)
    assert (player.time, player.playing) == (10.0, False)
    player.toggle()
    assert (player.time, player.playing) == (0.0, True)
    player.jump(-5.0)
    assert player.time == 0.0


def test_what_is_hidden_takes_its_children_along():
    places = {"a": Place(visible=False), "a/b": Place()}
    assert not is_shown("a/b", places)
    assert is_shown("c", places)


def test_beams_end_at_the_seabed_and_follow_the_mounting_of_the_log():
    own = "vehicle_overrides={environment.seabed_depth_m: 11.5, sensors.dvl.rpy_deg: [0, 10, 0]}"
    vehicle = load_scenario("hover", (own,)).load_vehicle()
    model = SceneModel(Setting(vehicle))
    places = model.all_places(level(vehicle))
    mount = quat_to_matrix(rpy_to_quat(0.0, np.radians(10.0), 0.0))
    for number in range(4):
        centre, R = world_pose(f"estimated/beam_{number}", places)
        half = places[f"estimated/beam_{number}"].size[2]
        start, end = centre + half * R[:, 2], centre - half * R[:, 2]  # the cone's tip is at +z
        assert np.allclose(start, vehicle.sensors.dvl.position_m + np.array([1.0, 2.0, 10.0]))
        assert end[2] == pytest.approx(11.5)
        assert (mount.T @ -R[:, 2])[2] == pytest.approx(np.cos(np.radians(30.0)))


def test_a_camera_shows_what_it_sees_and_its_marker_lies_where_the_file_says():
    vehicle = load_scenario("manipulation_marker").load_vehicle()
    section = vehicle.sensors.mounted["target_marker"]
    model = SceneModel(Setting(vehicle))
    places = model.all_places(level(vehicle))
    points = places["estimated/view_target_marker"].points
    tip, corners = points[0], points[1:5]
    assert np.allclose(tip, section.position_m)
    rays = (corners - tip) @ section.sensor_axes  # x right, y down, z along the view
    sideways, updown = np.degrees(2.0 * np.arctan(np.abs(rays[:, :2] / rays[:, 2:]))).T
    assert np.allclose(sideways, section.field_of_view_deg[0])
    assert np.allclose(updown, section.field_of_view_deg[1])
    marker = places["marker_target_marker"]
    assert marker.position.tolist() == [0.95, -0.15, 11.65]
    assert np.allclose(quat_to_matrix(marker.quaternion)[:, 2], [0.0, 0.0, -1.0])  # faces up


def test_what_is_drawn_together_covers_the_same_triangles_and_never_moves(source, model):
    assert not model.still & model.places(source.moment(5.0)).keys()
    joined, gone = batches(model.nodes, model.nodes.keys() - model.still)
    assert gone <= model.still
    assert len(gone) > 30  # of the two vehicles: fins, ducts; blades of the one
    places = {name: node.place for name, node in model.nodes.items()}
    for batch in joined:
        carrier = parent(batch.name)
        centre, R = world_pose(carrier, places)
        corners = centre + batch.vertices @ R.T
        parts = [name for name in gone if model.nodes[name].look == batch.look
                 and name.startswith(f"{carrier}/")]  # fmt: skip
        expected = []
        for name in parts:
            where, turn = world_pose(name, places)
            vertices = unit_mesh(model.nodes[name].look.kind)[0] * places[name].size
            expected.append(where + vertices @ turn.T)
        known = {tuple(row) for row in np.round(np.concatenate(expected), 9) + 0.0}
        assert {tuple(row) for row in np.round(corners, 9) + 0.0} <= known
        assert batch.faces.max() == len(batch.vertices) - 1


def test_a_description_tells_places_and_colours_and_not_the_noise_of_thrusts(source, model):
    told = describe(model, source.moment(7.5), "wide")["shown"]
    hull = source.moment(7.5).estimated.position
    assert told["estimated/hull"][:2] == ["sphere", "#f5bd29"]
    assert np.abs(np.subtract(told["estimated/hull"][2], hull)).max() < 1e-3
    assert told["obstacle_rock"][2] == [4.0, 1.0, 11.0]
    assert not [name for name in told if "thrust_" in name or "force_" in name]
