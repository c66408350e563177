"""`uvms added-mass`: it prints an entry of a vehicle file, and names what it cannot do."""

import numpy as np
import pytest
import trimesh
import yaml

from uvms_bringup.cli import main
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.locate import reference_file


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def run(capsys):
    """Runs the command; comments and matrix of its output."""

    def printed(*arguments):
        assert main(["added-mass", *arguments]) == 0
        out = capsys.readouterr().out
        comments = [line for line in out.splitlines() if line.startswith("#")]
        return "\n".join(comments), np.array(yaml.safe_load(out)["added_mass"])

    return printed


@pytest.fixture
def error(capsys):
    def run(*arguments):
        assert main(["added-mass", *arguments]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert err.startswith("error: ")
        return err

    return run


def test_output_is_an_entry_of_the_vehicle_file(run):
    comments, matrix = run("spheroid:2.4,0.38", "--panels", "800")
    for text in ("unbounded water of 1025 kg/m^3", "volume 0.1814", "Lamb", "asymmetry before"):
        assert text in comments
    vehicle = load_vehicle(overrides={"hull.added_mass": matrix.tolist()})
    exact = np.diag(load_vehicle().hull.added_mass)
    own = np.diag(vehicle.hull.added_mass)
    terms = [0, 1, 2, 4, 5]
    np.testing.assert_allclose(own[terms], exact[terms], rtol=0.01)
    assert own[3] == 0.0  # a bare spheroid; the file's roll is that of its fins


def test_mesh_in_millimetres_with_z_upwards(run, error):
    """A ball whose middle is 200 mm above the mesh's origin and 100 mm behind the body's."""
    ball = trimesh.creation.icosphere(subdivisions=2, radius=250.0)
    ball.apply_translation([300.0, 0.0, 200.0])
    ball.export("ball.stl")
    assert "--scale 0.001 for millimetres" in error("ball.stl")
    frame = ("--scale", "0.001", "--rpy", "180,0,0", "--about", "0.4,0,0", "--density", "1000")
    comments, matrix = run("ball.stl", *frame, "--panels", "400")
    assert "its centre -0.1, 0, -0.2 m" in comments
    assert "convergence: extrapolation changes" in comments
    assert "--about X,Y,Z?" not in comments
    elsewhere, _ = run("ball.stl", "--scale", "0.001", "--panels", "400")
    assert "the frame's origin lies outside the body: --about X,Y,Z?" in elsewhere
    m = 0.5 * 1000.0 * 4.0 / 3.0 * np.pi * 0.25**3
    assert np.diag(matrix)[:3] == pytest.approx([m] * 3, rel=0.05)  # inscribed: 4 % less volume
    assert matrix[0, 4] == pytest.approx(-0.2 * m, rel=0.05)
    assert matrix[1, 3] == pytest.approx(0.2 * m, rel=0.05)
    assert matrix[2, 4] == pytest.approx(0.1 * m, rel=0.05)


def test_large_mesh_is_solved_as_it_is(run, monkeypatch):
    monkeypatch.setattr("uvms_dynamics.panel_method.bodies.MOST_HALVED", 800)
    trimesh.creation.icosphere(subdivisions=2, radius=0.25).export("ball.obj")
    comments, matrix = run("ball.obj", "--panels", "800")
    assert "convergence: not estimated; --panels 1280 would estimate it" in comments
    assert np.linalg.eigvalsh(matrix)[0] >= -1e-9


def test_parts_of_a_vehicle_file(run, error):
    file = str(reference_file())
    comments, matrix = run("forearm", "--vehicle", file, "--panels", "400")
    now = np.array(load_vehicle().arm.links[2].added_mass)
    assert "vehicle file now" in comments
    assert 0.8 * now[0, 0] < matrix[0, 0] < 0.95 * now[0, 0]  # round ends, water escapes
    assert matrix[0, 4] == pytest.approx(0.19 * matrix[0, 0], rel=1e-3)
    strips = next(line for line in comments.splitlines() if "strip theory" in line)
    assert strips.split()[5] == "-"  # X and Y across, Z along
    assert strips.endswith("an upper bound across the axis")
    comments, _ = run("hull", "--vehicle", file, "--panels", "400")
    assert "K of the bare shape is 0: the file's 0.80573 kg m^2" in comments
    assert "it has hull, swing_link, upper_arm" in error("rudder", "--vehicle", file)
    assert "--scale and --about: not for part hull of a vehicle file" in error(
        "hull", "--vehicle", file, "--scale", "1", "--about", "0,0,1"
    )
    for part in ("hull", "forearm"):
        assert "name the file with --vehicle FILE" in error(part)


def test_mistakes_are_named(error):
    assert "hull.stl: there is no such mesh file" in error("hull.stl")
    assert "shape 'ball' is unknown; choose one of sphere:RADIUS" in error("ball:1")
    assert "--flip: not for shape sphere:1" in error("sphere:1", "--flip")
    assert "sphere:0: radius 0: must be a length in m" in error("sphere:0")
    assert "9 panels are too few" in error("sphere:1", "--panels", "9")
    assert "density 0: must be a density" in error("sphere:1", "--density", "0")


def test_vectors_are_three_numbers(capsys):
    with pytest.raises(SystemExit):
        main(["added-mass", "sphere:1", "--rpy", "180,0"])
    assert "'180,0' must be three numbers, as in 0.1,0,0" in capsys.readouterr().err
