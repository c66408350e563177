"""Panel method: Lamb's bodies, frames, meshes, and what it refuses."""

import re

import numpy as np
import pytest
import trimesh

from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.hull import Spheroid
from uvms_core.vehicle.locate import reference_file
from uvms_core.vehicle.shapes import spheroid_added_mass
from uvms_dynamics.panel_method import (
    Box,
    Cylinder,
    Ellipsoid,
    PanelMethodError,
    Panels,
    added_mass_yaml,
    estimate,
    in_frame,
    load_panels,
    mesh_body,
    parse_solid,
    pose_of,
    shape_body,
    slender_cylinder_added_mass,
    solve,
    solver,
    vehicle_body,
)
from uvms_dynamics.panel_method.checks import check_closed, check_outward
from uvms_dynamics.panel_method.panels import with_short_edges

RHO = 1025.0
HERE = (np.zeros(3), np.eye(3))
TURNED = pose_of(np.array([0.7, -0.2, 0.4]), np.array([30.0, -50.0, 110.0]))
SHAPES = [
    "sphere:0.25",
    "spheroid:2.4,0.38",
    "ellipsoid:1,0.5,0.3",
    "cylinder:0.05,0.5",
    "box:3,2,1",
]


@pytest.fixture(scope="module")
def hull():
    return estimate(shape_body("spheroid:2.4,0.38", HERE, RHO, 1600).levels, RHO)


@pytest.fixture
def stl(tmp_path):
    """Writes panels to an STL file, in millimetres or in another unit."""

    def write(panels, unit=1e-3):
        a, b, c, d = panels.faces.T
        triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)[c != d]])
        mesh = trimesh.Trimesh(panels.vertices / unit, triangles, process=False)
        mesh.export(tmp_path / "body.stl")
        return tmp_path / "body.stl"

    return write


def test_spheroid_is_lambs_within_one_per_cent(hull):
    """The reference hull; its roll is nothing, and nothing couples."""
    shape = Spheroid(length_m=2.4, diameter_m=0.38, roll_added_inertia_fraction=0.0)
    exact = spheroid_added_mass(shape, RHO)
    terms = [0, 1, 2, 4, 5]
    np.testing.assert_allclose(np.diag(hull.matrix)[terms], np.diag(exact)[terms], rtol=3e-3)
    assert hull.matrix[3, 3] < 1e-9
    assert np.abs(hull.matrix - np.diag(np.diag(hull.matrix))).max() < 1e-5 * 171.6
    assert hull.volume == pytest.approx(np.pi / 6.0 * 2.4 * 0.38**2, rel=5e-4)


def test_change_is_near_the_error_of_the_finest(hull):
    exact = np.diag(Ellipsoid(2.4, 0.38, 0.38).closed_form(RHO))
    error = np.abs(np.diag(hull.solved[-1][1])[:3] / exact[:3] - 1.0)
    assert error == pytest.approx(hull.change[:3], abs=2e-3)
    assert hull.change[3] == 0.0


def test_ellipsoid_has_six_terms_within_one_per_cent():
    body = shape_body("ellipsoid:1,0.5,0.3", HERE, RHO, 1200)
    exact = np.diag(Ellipsoid(1.0, 0.5, 0.3).closed_form(RHO))
    found = np.diag(estimate(body.levels, RHO).matrix)
    assert exact.min() > 0.3
    np.testing.assert_allclose(found, exact, rtol=5e-3)


def test_closed_form_of_an_ellipsoid_becomes_the_spheroids():
    shape = Spheroid(length_m=2.4, diameter_m=0.38, roll_added_inertia_fraction=0.0)
    form = Ellipsoid(2.4, 0.38, 0.38).closed_form(RHO)
    np.testing.assert_allclose(form, spheroid_added_mass(shape, RHO), rtol=1e-10, atol=1e-9)
    flat = np.diag(Ellipsoid(1e-5, 2.0, 2.0).closed_form(RHO))  # a disc: 8/3 rho r^3
    assert flat[0] == pytest.approx(8.0 / 3.0 * RHO, rel=1e-4)
    assert flat[4] == pytest.approx(16.0 / 45.0 * RHO, rel=1e-4)


def test_sphere_off_the_origin_couples_as_half_its_water_there():
    """A point mass m = rho V/2 at c: m [c]x^T in the corner, m (c.c E - c c^T) in rotation."""
    body = shape_body("sphere:0.25", pose_of(np.array([0.5, 0.2, -0.1]), np.zeros(3)), RHO, 800)
    m, (x, y, z) = 0.5 * RHO * 4.0 / 3.0 * np.pi * 0.25**3, (-0.5, -0.2, 0.1)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    exact = m * np.block([[np.eye(3), -cross], [cross, -cross @ cross]])
    found = estimate(body.levels, RHO)
    np.testing.assert_allclose(found.matrix, exact, rtol=5e-3, atol=2e-3 * m)
    assert np.linalg.eigvalsh(found.matrix)[:3] == pytest.approx(0.0, abs=1e-3 * m)


@pytest.mark.parametrize("word", ["ellipsoid:1,0.5,0.3", "box:0.5,0.4,0.3"])
def test_frame_changes_as_x_transposed_m_x(word):
    """Solved in a turned and moved frame against solved at home and carried there."""
    solid = parse_solid(word)
    home = solve(solid.panels(200), RHO)
    away = solve(solid.panels(200).in_frame(*TURNED), RHO)
    np.testing.assert_allclose(away, in_frame(home, *TURNED), atol=2e-3 * np.abs(home).max())


def test_energy_does_not_depend_on_the_frame():
    """X by what it is for: the same motion, written in both frames, has the same energy."""
    M = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]) + 0.1
    position, rotation = TURNED
    v, w = np.array([0.3, -0.2, 0.5]), np.array([1.0, 0.4, -0.7])
    at_body = np.concatenate([rotation.T @ (v + np.cross(w, position)), rotation.T @ w])
    twist = np.concatenate([v, w])
    assert twist @ in_frame(M, position, rotation) @ twist == pytest.approx(at_body @ M @ at_body)


def test_nothing_happens_at_the_plane_z_0():
    """Where other problems have their water surface: the same body above, across and below."""
    across = Cylinder(0.05, 0.3).panels(200)
    results = [
        solve(across.in_frame(np.array([0.0, 0.0, z]), np.eye(3)), RHO)[:3, :3]
        for z in (0.0, 0.6, -0.6, 300.0)
    ]
    for result in results[1:]:
        np.testing.assert_allclose(result, results[0], rtol=1e-3, atol=1e-4)


def test_size_does_not_matter():
    """A millimetre and a hundred metres: rho L^3, L^4 and L^5."""
    one = solve(Ellipsoid(1.0, 0.5, 0.3).panels(200), RHO)
    for size in (1e-3, 1e2):
        units = np.array([1.0, 1.0, 1.0, size, size, size]) * size**1.5
        same = solve(Ellipsoid(size, 0.5 * size, 0.3 * size).panels(200), RHO)
        np.testing.assert_allclose(same / np.outer(units, units), one, atol=1e-6 * one.max())


def test_slender_cylinder_nears_strip_theory_from_below():
    shares = []
    for ratio in (5.0, 20.0, 80.0):
        found = estimate(shape_body(f"cylinder:0.05,{0.1 * ratio}", HERE, RHO, 1000).levels, RHO)
        strips = slender_cylinder_added_mass(0.05, 0.1 * ratio, RHO)
        shares.append(np.diag(found.matrix)[[1, 4]] / np.diag(strips)[[1, 4]])
    assert (np.diff(shares, axis=0) > 0.0).all()
    assert np.all(shares[-1] > [0.985, 0.96])
    assert np.all(shares[-1] < 1.0)


def test_cube_is_the_literatures():
    """0.64 rho a^3."""
    found = estimate(shape_body("box:1,1,1", HERE, 1.0, 1500).levels, 1.0)
    assert np.diag(found.matrix)[:3] == pytest.approx([0.64] * 3, abs=0.01)


@pytest.mark.parametrize("word", SHAPES)
def test_shapes_are_closed_and_have_their_volume(word):
    solid = parse_solid(word)
    volumes = {
        "sphere": lambda r: 4.0 / 3.0 * np.pi * r**3,
        "spheroid": lambda length, d: np.pi / 6.0 * length * d**2,
        "ellipsoid": lambda x, y, z: np.pi / 6.0 * x * y * z,
        "cylinder": lambda r, length: np.pi * r**2 * length,
        "box": lambda x, y, z: x * y * z,
    }
    name, _, sizes = word.partition(":")
    for panels in (solid.panels(300), solid.panels(300, 1), solid.panels(300).refined()):
        check_closed(panels, word)
        assert check_outward(panels, word) == 1
        np.testing.assert_allclose(panels.centroid(), 0.0, atol=1e-12)
    fine = solid.panels(300, 4).volume()
    assert fine == pytest.approx(volumes[name](*map(float, sizes.split(","))), rel=1e-3)


def test_halving_leaves_the_surface():
    coarse = with_short_edges(Box(3.0, 2.0, 1.0).panels(60), 500).in_frame(*TURNED)
    assert coarse.count >= 500
    for panels in (coarse, coarse.refined(), coarse.flipped().flipped()):
        assert panels.volume() == pytest.approx(6.0, rel=1e-12)
        area = np.linalg.norm(panels.area_vectors(), axis=1)
        assert area.sum() == pytest.approx(22.0, rel=1e-12)
        np.testing.assert_allclose(panels.centroid(), TURNED[0], rtol=1e-9)
    assert coarse.refined().count == 4 * coarse.count


def test_mesh_goes_round_through_a_file(stl):
    """Written in millimetres, forward-port-up, its origin at the stern; solved about the middle."""
    ball = trimesh.creation.icosphere(subdivisions=2)
    triangles = np.asarray(ball.faces)[:, [0, 1, 2, 2]]
    hull = Panels(np.asarray(ball.vertices) * [0.5, 0.2, 0.3], triangles)
    turned = pose_of(np.zeros(3), np.array([180.0, 0.0, 0.0]))
    ahead = pose_of(np.array([-0.5, 0.0, 0.0]), np.zeros(3))
    file = stl(hull.in_frame(*turned).in_frame(*ahead))
    pose = pose_of(np.array([0.5, 0.0, 0.0]), np.array([180.0, 0.0, 0.0]))
    found = solve(load_panels(file, scale=1e-3).in_frame(*pose), RHO)
    np.testing.assert_allclose(found, solve(hull, RHO), atol=1e-4 * found.max())


def test_long_thin_triangles_are_cut_before_they_are_solved(stl):
    """A cuboid as CAD writes it: twelve triangles."""
    box = Box(0.5, 0.4, 0.3)
    corners = Panels(*trimesh_box(0.5, 0.4, 0.3))
    found = estimate(mesh_body(stl(corners), HERE, RHO, 1600, scale=1e-3).levels, RHO)
    same = estimate(tuple(box.panels(400, n) for n in (0, 1)), RHO)
    # Along the edges the flow is singular; the shape's own grid is finer there.
    np.testing.assert_allclose(np.diag(found.matrix)[:3], np.diag(same.matrix)[:3], rtol=0.015)
    np.testing.assert_allclose(np.diag(found.matrix)[3:], np.diag(same.matrix)[3:], rtol=0.04)


def test_needles_are_cut_even_where_there_are_panels_enough(stl):
    """A capsule with twelve sides a metre long: as they are, its rotation is far too small."""
    mesh = trimesh.creation.capsule(height=1.0, radius=0.1, count=[12, 12])
    capsule = Panels(np.asarray(mesh.vertices), np.asarray(mesh.faces)[:, [0, 1, 2, 2]])
    sure = np.diag(solve(with_short_edges(capsule, 2000), RHO))[:5]
    raw = np.diag(solve(capsule, RHO))[:5]
    assert raw[3] < 0.8 * sure[3]
    found = estimate(mesh_body(stl(capsule), HERE, RHO, 800, scale=1e-3).levels, RHO)
    np.testing.assert_allclose(np.diag(found.matrix)[:5], sure, rtol=0.03)


def trimesh_box(*lengths):
    mesh = trimesh.creation.box(lengths)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)[:, [0, 1, 2, 2]]


def with_hole(panels):
    return Panels(panels.vertices, panels.faces[1:])


def with_one_turned(panels):
    faces = panels.faces.copy()
    faces[0] = faces[0, [1, 0, 3, 2]]
    return Panels(panels.vertices, faces)


def with_inner_wall(panels):
    inner = panels.flipped()
    vertices = np.concatenate([panels.vertices, 0.9 * inner.vertices])
    return Panels(vertices, np.concatenate([panels.faces, inner.faces + len(panels.vertices)]))


def with_another(panels, shift, size=1.0):
    vertices = np.concatenate([panels.vertices, size * panels.vertices + shift])
    return Panels(vertices, np.concatenate([panels.faces, panels.faces + len(panels.vertices)]))


def with_battery(panels):
    return with_another(panels, [0.0, 0.0, 0.0], 0.5)


def with_thruster_that_overlaps(panels):
    return with_another(panels, [0.4, 0.3, 0.2])


@pytest.mark.parametrize(
    ("spoil", "text"),
    [
        (with_hole, "the surface is not closed: 3 of "),
        (with_one_turned, "neighbouring panels have opposite orientation at 3 edges"),
        (with_inner_wall, "2 separate surfaces, one of which encloses -"),
        (with_battery, "2 separate surfaces, two of which overlap or lie within"),
        (with_thruster_that_overlaps, "two of which overlap .*at "),
        (Panels.flipped, "the normals point inwards .enclosed volume -0.06.* --flip"),
    ],
)
def test_names_what_is_wrong_with_a_mesh(stl, spoil, text):
    triangles = Panels(*trimesh_box(0.5, 0.4, 0.3))
    with pytest.raises(PanelMethodError, match=text):
        load_panels(stl(spoil(triangles), unit=1.0))


def test_two_bodies_apart_are_one_vehicle(stl):
    """Far from each other, each carries what it carries alone."""
    one = Panels(*trimesh_box(0.5, 0.4, 0.3))
    file = stl(with_another(one, [30.0, 0.0, 0.0]))
    both = solve(with_short_edges(load_panels(file, scale=1e-3), 600), RHO)
    alone = solve(with_short_edges(one, 300), RHO)
    np.testing.assert_allclose(both[:3, :3], 2.0 * alone[:3, :3], rtol=1e-3, atol=0.05)


def test_flip_mends_normals_that_point_inwards(stl):
    file = stl(Panels(*trimesh_box(0.5, 0.4, 0.3)).flipped(), unit=1.0)
    assert load_panels(file, flip=True).volume() == pytest.approx(0.06, rel=1e-6)


def test_millimetres_are_noticed(stl):
    file = stl(Panels(*trimesh_box(0.457, 0.338, 0.254)))
    with pytest.raises(PanelMethodError, match=r"457 m long .* --scale 0\.001 for millimetres"):
        load_panels(file)
    assert load_panels(file, scale=1e-3).volume() == pytest.approx(0.0392, rel=1e-3)
    with pytest.raises(PanelMethodError, match="scale -1: must be the file's unit in metres, > 0"):
        load_panels(file, scale=-1.0)


def test_unreadable_files_are_named(tmp_path):
    with pytest.raises(PanelMethodError, match=r"hull\.stl: there is no such mesh file"):
        load_panels(tmp_path / "hull.stl")
    for name in ("hull.stl", "hull.gdf", "hull.doc"):
        (tmp_path / name).write_text("not a mesh")
        with pytest.raises(PanelMethodError, match=name):
            load_panels(tmp_path / name)


def test_native_format_of_panel_codes_is_read(tmp_path):
    """WAMIT's .gdf: four corners a panel."""
    panels = Box(0.5, 0.4, 0.3).panels(60)
    corners = panels.vertices[panels.faces].reshape(-1, 3)
    lines = ["cuboid", "1.0 9.81", "0 0", str(panels.count)]
    lines += [" ".join(f"{value:.9f}" for value in point) for point in corners]
    (tmp_path / "cuboid.gdf").write_text("\n".join(lines))
    assert load_panels(tmp_path / "cuboid.gdf").volume() == pytest.approx(0.06, rel=1e-6)


@pytest.mark.parametrize(
    ("word", "text"),
    [
        (
            "ball:1",
            "shape 'ball' is unknown; choose one of sphere:RADIUS, spheroid:LENGTH,DIAMETER",
        ),
        ("sphere:big", "must be sphere:RADIUS with numbers in m"),
        ("box:1,2", "has 2 numbers; must be box:LENGTH_X,LENGTH_Y,LENGTH_Z"),
        ("cylinder:-1,2", "radius -1: must be a length in m, > 0"),
        ("sphere:nan", "radius nan: must be a length in m, > 0"),
    ],
)
def test_unknown_shapes_are_named_with_the_choices(word, text):
    with pytest.raises(PanelMethodError, match=text):
        parse_solid(word)


def test_memory_is_asked_for_before_it_is_taken(monkeypatch):
    monkeypatch.setattr(solver, "memory_available", lambda: 1e6)
    with pytest.raises(PanelMethodError, match=r"need about .* GB.*at most 125 panels fit"):
        solve(Box(1.0, 1.0, 1.0).panels(400), RHO)


@pytest.mark.parametrize("missing", ["capytaine", "trimesh"])
def test_missing_libraries_are_named_with_the_way_to_get_them(monkeypatch, stl, missing):
    file = stl(Panels(*trimesh_box(0.5, 0.4, 0.3)), unit=1.0)

    def absent(name, *_):
        raise ImportError(name)

    monkeypatch.setattr("uvms_dynamics.panel_method.optional.import_module", absent)
    with pytest.raises(PanelMethodError, match=f"needs {missing}, .*pip install capytaine trimesh"):
        solve(Box(1.0, 1.0, 1.0).panels(60), RHO) if missing == "capytaine" else load_panels(file)


def test_rows_load_in_a_vehicle_file(tmp_path):
    """Of full rank with noise, and of low rank (a sphere off the origin)."""
    rng = np.random.default_rng(3)
    noise = 1e-7 * rng.normal(size=(6, 6))
    full = np.diag([7.8, 171.6, 171.6, 1e-6, 42.7, 42.7]) + noise @ noise.T
    for matrix in (full, in_frame(np.diag([33.5] * 3 + [0.0] * 3), *TURNED)):
        rows = added_mass_yaml(matrix, indent="  ")
        text = reference_file().read_text(encoding="utf-8")
        text, count = re.subn(r"^  added_mass: spheroid.*$", rows, text, flags=re.MULTILINE)
        assert count == 1
        (tmp_path / "own.yaml").write_text(text, encoding="utf-8")
        hull = load_vehicle(tmp_path / "own.yaml").hull
        np.testing.assert_allclose(hull.added_mass, matrix, atol=1e-4 * matrix.max())


def test_parts_of_a_vehicle_are_found():
    vehicle = load_vehicle()
    body = vehicle_body(vehicle, "forearm", 400)
    low, high = (getattr(body.levels[0].vertices, end)(axis=0) for end in ("min", "max"))
    np.testing.assert_allclose([low, high], [[-0.04, -0.04, 0.0], [0.04, 0.04, 0.38]], atol=1e-9)
    strips = body.rows["strip theory, an upper bound across the axis"]
    file = np.array(vehicle.arm.links[2].added_mass)
    across = [0, 1, 3, 4, 5]
    np.testing.assert_allclose(
        strips[np.ix_(across, across)], file[np.ix_(across, across)], atol=1e-12
    )
    with pytest.raises(PanelMethodError, match="it has hull, swing_link, upper_arm, forearm"):
        vehicle_body(vehicle, "rudder")


def test_too_few_panels_and_wrong_water_are_refused():
    with pytest.raises(PanelMethodError, match="10 panels are too few"):
        shape_body("sphere:1", HERE, RHO, 10)
    with pytest.raises(PanelMethodError, match=r"density -1: must be .* > 0"):
        estimate((Box(1.0, 1.0, 1.0).panels(60),), -1.0)
