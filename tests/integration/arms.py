"""Vehicle files of arms with four to seven joints, made from those of the project."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from uvms_core.vehicle.locate import known_vehicles

POSTURES = {
    "home": {"shoulder": 10.0, "elbow": 115.0},
    "extended_starboard": {"swing": 90.0, "elbow": 0.0},
    "extended_port": {"swing": -45.0, "elbow": 0.0},
}


def five_joints() -> dict[str, Any]:
    """The reference vehicle whose wrist bends after it has turned."""
    data = _reference("five_joints")
    _add_bend(data["arm"])
    data["arm"]["stowed_deg"] = [0.0, 0.0, 135.0, 0.0, 0.0]
    return data


def seven_joints() -> dict[str, Any]:
    """The reference vehicle with a roll in the upper arm and a wrist of three axes."""
    data = _reference("seven_joints")
    arm = data["arm"]
    _add_bend(arm)
    arm["joints"].append({**arm["joints"][-1], "name": "spin", "alpha_deg": 0.0, "d_m": 0.1})
    arm["links"].append({**arm["links"][-1], "name": "gripper"})
    arm["links"][-2] = _short(arm["links"][-1], "bend_link")
    _add_roll(arm)
    arm["stowed_deg"] = [0.0, 0.0, 0.0, 135.0, 0.0, 0.0, 0.0]
    return data


def _reference(name: str) -> dict[str, Any]:
    data = yaml.safe_load(known_vehicles()["reference_auv"].read_text(encoding="utf-8"))
    data["name"], data["arm"]["postures_deg"] = name, POSTURES
    return data


def _add_bend(arm: dict[str, Any]) -> None:
    """A joint across the wrist, which has turned the tool about its own axis only."""
    wrist, gripper = arm["joints"][3], arm["links"][3]
    bend = {**wrist, "name": "bend", "alpha_deg": -90.0, "d_m": 0.0}
    arm["joints"].append(bend | {"lower_deg": -100.0, "upper_deg": 100.0})
    wrist["alpha_deg"] = 90.0
    arm["links"] = [*arm["links"][:3], _short(gripper, "wrist_link"), gripper]


def _add_roll(arm: dict[str, Any]) -> None:
    """The upper arm turns about its axis: the shoulder's link ends where the roll begins."""
    _, shoulder, elbow, *_ = arm["joints"]
    upper_arm = arm["links"][1]
    roll = {**shoulder, "name": "roll", "a_m": 0.0, "alpha_deg": -90.0, "d_m": 0.46}
    arm["joints"].insert(2, roll | {"lower_deg": -120.0, "upper_deg": 120.0})
    shoulder.update(a_m=0.0, alpha_deg=90.0, offset_deg=90.0)
    elbow["offset_deg"] = 0.0
    cylinder = upper_arm["cylinder"] | {"center_m": [0.0, 0.23, 0.0], "axis": [0.0, 1.0, 0.0]}
    arm["links"].insert(2, upper_arm | {"cylinder": cylinder})
    arm["links"][1] = _short(upper_arm, "shoulder_link")


def _short(link: dict[str, Any], name: str) -> dict[str, Any]:
    """A small body on the joint, in the place of a longer link."""
    shape = link["cylinder"] | {"center_m": [0.0] * 3, "length_m": 0.06}
    return link | {"name": name, "mass_kg": 0.4, "cylinder": shape}


MADE = {"five_joints": five_joints, "seven_joints": seven_joints}
VEHICLES = ("reference_auv", "bluerov2_alpha5", *MADE)


def vehicle_name(name: str, folder: Path) -> str:
    """What a scenario calls the vehicle: its name, or a file that is written to the folder."""
    if name not in MADE:
        return name
    path = folder / f"{name}.yaml"
    path.write_text(yaml.safe_dump(MADE[name]()), encoding="utf-8")
    return str(path)


every_arm = pytest.mark.parametrize("name", VEHICLES)
