"""The vehicle file: what it means, what it refuses and with which words."""

import re
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import yaml
from pydantic import BaseModel
from random_vehicles import REFERENCE, random_vehicle

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import (
    Vehicle,
    dump_vehicle,
    load_vehicle,
    vehicle_from_data,
    vehicle_from_yaml,
)
from uvms_core.vehicle.locate import reference_file
from uvms_dynamics import build_model, restoring_wrench


def refusal(**overrides):
    """Error text of the reference vehicle with `a__b` for `a.b`, without the file's name."""
    with pytest.raises(VehicleFileError) as fault:
        load_vehicle(overrides={path.replace("__", "."): v for path, v in overrides.items()})
    file = re.escape(str(reference_file()))
    return re.sub(rf"^{file}(?: with [^:]*)?: ", "", str(fault.value), flags=re.MULTILINE)


def test_counts_and_names():
    assert (REFERENCE.n_joints, REFERENCE.n_thrusters) == (4, 7)
    assert REFERENCE.joint_names == ("swing", "shoulder", "elbow", "wrist")
    assert REFERENCE.thruster_names[:3] == ("main", "side_fore", "side_aft")


UNITS = "_(m|kg|n|s|deg|hz|pa|m3|m2|s2|nm|rad|w|v|ohm)(_s|_s2|_m2|_m3|_rad)?$"
WITHOUT_UNIT = {
    "arm_efficiency",
    "roll_added_inertia_fraction",
    "axial_added_mass_fraction",
    "scale_error",
    "gyro_scale_error",
    "accelerometer_scale_error",
    "dead_zone",
    "drop_out_rate",
    "outlier_rate",
    "aspect_ratio",
    "drag_coefficient",
    "plate_drag_coefficient",
}


def scalar_fields(section):
    for name, field in section.model_fields.items():
        if field.annotation is float:
            yield name
        for inner in (field.annotation, *get_args(field.annotation)):
            if isinstance(inner, type) and issubclass(inner, BaseModel):
                yield from scalar_fields(inner)


def test_every_number_has_its_unit_in_its_name():
    names = set(scalar_fields(Vehicle))
    assert len(names) >= 50
    assert {name for name in names if not re.search(UNITS, name)} == WITHOUT_UNIT


def test_the_file_says_whose_data_it_is_not():
    assert "NOT THE AUTHORS' DATA" in reference_file().read_text(encoding="utf-8")


@pytest.mark.parametrize("vehicle", [REFERENCE, random_vehicle(3, 6)], ids=["reference", "random"])
def test_what_is_written_can_be_read_again(vehicle):
    text = dump_vehicle(vehicle)
    assert vehicle_from_yaml(text) == vehicle
    assert dump_vehicle(vehicle_from_yaml(text)) == text
    for word in ("neutral", "trim"):
        assert word not in text


def test_derived_values_follow_an_override():
    longer = load_vehicle(overrides={"hull.spheroid.length_m": 3.0})
    assert longer.hull.volume_m3 == pytest.approx(np.pi / 6 * 3.0 * 0.38**2)
    q = np.radians(longer.arm.stowed_deg)
    wrench = restoring_wrench(build_model(longer), np.array([0.0, 0.0, 0.0, 1.0]), q)
    np.testing.assert_allclose(wrench, 0.0, atol=1e-9)


def test_override_by_number_and_by_name():
    by_number = load_vehicle(overrides={"arm.joints.1.effort_limit_nm": 55})
    by_name = load_vehicle(overrides={"arm.joints.shoulder.effort_limit_nm": 55})
    assert by_number == by_name
    assert by_name.arm.joints[1].effort_limit_nm == 55.0


def test_override_of_one_component():
    assert load_vehicle(overrides={"hull.cg_m.2": 0.02}).hull.cg_m[2] == 0.02


def test_any_number_of_joints_and_thrusters():
    data = random_vehicle(1, 7).model_dump(mode="json")
    data["thrusters"] = data["thrusters"][:2]
    vehicle = vehicle_from_data(data)
    assert (vehicle.n_joints, vehicle.n_thrusters) == (7, 2)


def test_unknown_override_lists_the_choices():
    assert refusal(hull__mas_kg=3.0) == (
        "override hull.mas_kg: hull has no 'mas_kg'; choose from spheroid, volume_m3, mass_kg,"
        " cg_m, cb_m, inertia_kg_m2, added_mass, attachments, linear_damping,"
        " quadratic_damping, cross_terms, fins, boxes, speeds_m_s"
    )
    assert refusal(wings=3.0) == (
        "override wings: the vehicle file has no 'wings'; choose from name, environment, hull,"
        " thrusters, arm, sensors, tether, electrical"
    )
    assert refusal(thrusters__left__limit_n=1.0).startswith(
        "override thrusters.left.limit_n: thrusters has no 'left'; choose from 0, 1, 2, 3, 4, 5, 6,"
        " main, side_fore, side_aft, vertical_fore_port"
    )
    assert refusal(hull__mass_kg__unit=1.0) == (
        "override hull.mass_kg.unit: hull.mass_kg has no 'unit'; it has no fields"
    )


@pytest.mark.parametrize(
    ("path", "value", "text"),
    [
        ("arm.joints.0.effort_limit_nm", -3, "Input should be greater than 0 (got -3)"),
        ("arm.links.1.mass_kg", 0, "Input should be greater than 0 (got 0)"),
        ("hull.volume_m3", float("nan"), "Input should be a finite number (got nan)"),
        ("hull.mass_kg", "heavy", "must be a value or the word 'neutral' (got 'heavy')"),
        (
            "hull.inertia_kg_m2",
            [1, 1, 5],
            "no body has principal moments 1, 1, 5: the largest exceeds the others' sum"
            " (got [1, 1, 5])",
        ),
        (
            "hull.inertia_kg_m2",
            [[1, 2, 0], [2, 1, 0], [0, 0, 2]],
            "must be positive definite; its least principal moment is -1",
        ),
        ("hull.inertia_kg_m2", [1, 2], "needs 3 diagonal values or 3 rows, has 2 (got [1, 2])"),
        (
            "hull.added_mass",
            [1, 1, -2, 0, 0, 0],
            "must be positive semidefinite; its least eigenvalue is -2",
        ),
        ("hull.linear_damping", [1, 1, -2, 0, 0, 0], "every value must be >= 0"),
        ("thrusters.0.direction", [1, 1, 0], "must be a unit vector; its length is 1.41421"),
        (
            "thrusters.0.name",
            "side_aft",
            "thrusters: thruster names must differ; used more than once: side_aft",
        ),
        (
            "arm.joints.0.lower_deg",
            130,
            "arm.joints.0: lower_deg = 130 must be below upper_deg = 120",
        ),
        ("arm.stowed_deg", [0.0], "arm: stowed_deg has 1 entries for 4 joints"),
        (
            "arm.stowed_deg",
            [0.0, 0.0, 150.0, 0.0],
            "arm: stowed_deg: 150 of joint elbow is outside its limits 0 to 140",
        ),
        (
            "arm.drag_coefficient.reynolds",
            [1.0, 3.0],
            "arm.drag_coefficient: reynolds has 2 values, cd has 9; give one cd each",
        ),
        (
            "arm.links.0.cylinder",
            None,
            "arm.links.0.volume_m3: 'cylinder' needs the section arm.links.0.cylinder",
        ),
        ("hull.spheroid", None, "hull.volume_m3: 'spheroid' needs the section hull.spheroid"),
        (
            "hull.spheroid.diameter_m",
            3.0,
            "hull.spheroid.diameter_m: must be below length_m = 2.4 (a prolate spheroid) (got 3.0)",
        ),
        ("sensors.imu.rate_hz", 0, "sensors.imu.rate_hz: Input should be greater than 0 (got 0)"),
        ("environment.gravity_m_s2", "g", "Input should be a valid number"),
    ],
)
def test_a_wrong_value_is_named(path, value, text):
    message = refusal(**{path.replace(".", "__"): value})
    assert text in message
    assert message.startswith(path.rsplit(".", 1)[0].split(".")[0])
    assert len(message.splitlines()) == 1


def test_every_fault_gets_its_line():
    message = refusal(hull__mass_kg=-1.0, arm__base__position_m=[0.0])
    assert [line.split(":")[0] for line in message.splitlines()] == [
        "hull.mass_kg",
        "arm.base.position_m.1",
        "arm.base.position_m.2",
    ]


def test_a_vehicle_that_cannot_be_neutral_is_refused():
    assert "hull.mass_kg: Input should be greater than 0" in refusal(arm__links__0__mass_kg=1e6)


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_missing_file(tmp_path):
    with pytest.raises(VehicleFileError, match=r"nowhere\.yaml: cannot be read: .*No such file"):
        load_vehicle(tmp_path / "nowhere.yaml")


def test_a_file_that_is_no_yaml(tmp_path):
    with pytest.raises(VehicleFileError, match=r"mine\.yaml: is not valid YAML"):
        load_vehicle(written(tmp_path, "hull: [1, 2"))


def test_a_key_given_twice(tmp_path):
    with pytest.raises(VehicleFileError, match="the key 'name' is given twice"):
        load_vehicle(written(tmp_path, "name: a\nname: b\n"))


def test_an_empty_file(tmp_path):
    with pytest.raises(VehicleFileError, match="write a group of values"):
        load_vehicle(written(tmp_path, ""))


def test_an_unknown_field_lists_the_known_ones(tmp_path):
    data = yaml.safe_load(reference_file().read_text(encoding="utf-8"))
    data["arm"]["joints"][1]["colour"] = "red"
    with pytest.raises(VehicleFileError) as fault:
        load_vehicle(written(tmp_path, yaml.safe_dump(data)))
    assert "arm.joints.1.colour: Extra inputs are not permitted; known names here: a_m," in str(
        fault.value
    )


def test_a_missing_field_is_named(tmp_path):
    data = yaml.safe_load(reference_file().read_text(encoding="utf-8"))
    del data["hull"]["cb_m"]
    with pytest.raises(VehicleFileError, match=r"hull\.cb_m: Field required"):
        load_vehicle(written(tmp_path, yaml.safe_dump(data)))
