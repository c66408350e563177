"""Printed tables are taken: what differs by rounding is evened out and noted, the rest named."""

import numpy as np
import pytest
import yaml

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import dump_vehicle, examine_vehicle, load_vehicle, vehicle_from_yaml

# Added mass of the RexROV as its model files print it: row 3, column 6 and row 6, column 3 differ.
REXROV = [
    [779.79, -6.8773, -103.32, 8.5426, -165.54, -7.8033],
    [-6.8773, 1222, 51.29, 409.44, -5.8488, 62.726],
    [-103.32, 51.29, 3659.9, 6.1112, -386.42, 10.774],
    [8.5426, 409.44, 6.1112, 534.9, -10.027, 21.019],
    [-165.54, -5.8488, -386.42, -10.027, 842.69, -1.1162],
    [-7.8033, 62.726, 10.775, 21.019, -1.1162, 224.32],
]


def refusal(path, value) -> str:
    with pytest.raises(VehicleFileError) as fault:
        load_vehicle(overrides={path: value})
    return str(fault.value)


def test_the_printed_added_mass_of_the_rexrov_is_taken_with_a_note():
    found = examine_vehicle(overrides={"hull.added_mass": REXROV})
    matrix = np.array(found.vehicle.hull.added_mass)
    np.testing.assert_array_equal(matrix, matrix.T)
    assert matrix[2, 5] == pytest.approx(10.7745, abs=1e-12)
    assert found.notes == (
        "hull.added_mass: row 3, column 6 is 10.774 and row 6, column 3 is 10.775; both taken as"
        " 10.7745",
    )


@pytest.mark.parametrize(("off", "taken"), [(0.9e-3, True), (1.1e-3, False), (-0.5, False)])
def test_a_matrix_is_symmetric_to_a_thousandth(off, taken):
    inertia = [[10.0, 2.0, 0.0], [2.0 * (1.0 + off), 12.0, 0.0], [0.0, 0.0, 12.0]]
    path = "hull.inertia_kg_m2"
    if taken:
        found = np.array(load_vehicle(overrides={path: inertia}).hull.inertia_kg_m2)
        np.testing.assert_array_equal(found, found.T)
    else:
        text = refusal(path, inertia)
        assert "hull.inertia_kg_m2: must be symmetric: row 1, column 2 is 2 and row 2," in text
        assert f"column 1 is {2.0 * (1.0 + off):g}; they differ by {2.0 * abs(off):.4g}" in text


def test_an_entry_of_the_wrong_sign_is_named():
    wrong = [list(row) for row in REXROV]
    wrong[5][2] = -10.775
    text = refusal("hull.added_mass", wrong)
    assert "row 3, column 6 is 10.774 and row 6, column 3 is -10.775" in text


@pytest.mark.parametrize("digits", [3, 4, 5, 6, 7])
def test_directions_with_a_few_digits_become_unit_vectors(digits):
    half = round(np.sqrt(0.5), digits)
    found = examine_vehicle(overrides={"thrusters.1.direction": [half, -half, 0.0]})
    direction = np.array(found.vehicle.thrusters[1].direction)
    assert np.linalg.norm(direction) == pytest.approx(1.0, abs=1e-6)
    np.testing.assert_allclose(direction, [np.sqrt(0.5), -np.sqrt(0.5), 0.0], atol=1e-6)
    length = np.hypot(half, half)
    noted = () if abs(length - 1.0) < 1e-6 else (f"its length is {length:.6g}",)
    assert len(found.notes) == len(noted)
    for note, text in zip(found.notes, noted, strict=True):
        assert note.startswith("thrusters.1.direction: ")
        assert text in note


def test_a_cylinders_axis_is_a_direction_as_well():
    axis = {"arm.links.1.cylinder.axis": [0.70711, 0.70711, 0.0]}
    notes = examine_vehicle(overrides=axis).notes
    assert [note.split(":")[0] for note in notes] == ["arm.links.1.cylinder.axis"]


@pytest.mark.parametrize("length", [0.0, 0.99, 1.0015, 2.0])
def test_a_direction_that_is_no_unit_vector_is_refused(length):
    text = refusal("thrusters.0.direction", [length, 0.0, 0.0])
    assert f"must be a unit vector; its length is {length:g}" in text


def test_notes_are_of_the_file_and_of_the_overrides(tmp_path):
    data = yaml.safe_load(dump_vehicle(load_vehicle()))
    data["hull"]["added_mass"] = REXROV
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    found = examine_vehicle(path, {"thrusters.0.direction": [0.9999, 0.0, 0.0]})
    assert [note.split(":")[0] for note in found.notes] == [
        "hull.added_mass",
        "thrusters.0.direction",
    ]


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_vehicles_of_the_project_need_no_rounding(name):
    assert examine_vehicle(name).notes == ()


def test_what_was_evened_out_is_written_and_read_without_change():
    changes = {"hull.added_mass": REXROV, "thrusters.1.direction": [0.707, -0.707, 0.0]}
    vehicle = load_vehicle(overrides=changes)
    assert vehicle_from_yaml(dump_vehicle(vehicle)) == vehicle
