"""The pages that list every field are those of the present models."""

import re

import pytest
from project import ROOT
from pydantic import BaseModel

from uvms_bringup.fields import PAGES
from uvms_bringup.scenario import Scenario
from uvms_core.vehicle import Vehicle, load_vehicle

ROW = re.compile(r"^\| `([^`]+)` \| (.+) \| (.+) \| (.*) \| (.+) \|$", re.MULTILINE)


def rows(name):
    """Type, default, bounds and meaning by path."""
    text = (ROOT / "docs" / name).read_text(encoding="utf-8")
    return {path: cells for path, *cells in ROW.findall(text)}


@pytest.mark.parametrize("name", PAGES)
def test_the_page_is_current(name):
    expected = PAGES[name]()
    text = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert text == expected, "run `uvms fields --output docs`"


def paths(values, prefix=""):
    """Dotted path of every value of a model, with items of lists by name or as 0."""
    for key, value in values:
        path = f"{prefix}{key}"
        if isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
            item = "NAME" if hasattr(value[0], "name") else "0"
            path, value = f"{path}.{item}", value[0]
        if isinstance(value, BaseModel):
            yield from paths(value, f"{path}.")
        else:
            yield path


def test_every_value_of_a_vehicle_has_its_row_and_its_meaning():
    found = rows("fields-vehicle.md")
    for vehicle in (load_vehicle(), load_vehicle("bluerov2_alpha5")):
        assert set(paths(vehicle)) <= found.keys()
    assert len(found) > 100
    assert set(Vehicle.model_fields) <= found.keys()


def test_every_value_of_a_scenario_has_its_row_and_its_meaning():
    found = rows("fields-scenario.md")
    assert set(paths(Scenario(scenario="x", duration_s=1.0))) <= found.keys()
    assert len(found) > 100


def test_rows_say_what_the_models_allow():
    scenario, vehicle = rows("fields-scenario.md"), rows("fields-vehicle.md")
    assert scenario["plant.step_s"][:3] == ["number", "`0.005`", "> 0, ≤ 0.05"]
    assert scenario["seed"][2] == f"≥ 0, ≤ {2**63 - 1}"
    assert scenario["control.vehicle.k_error"][2] == "each > 0; length 6"
    assert scenario["duration_s"][1] == "required"
    assert vehicle["hull.mass_kg"][:3] == ["number", "`neutral`", "> 0"]
    assert vehicle["tether.weight_per_m_n"][2] == "≥ -1000, ≤ 1000"
    assert vehicle["arm.joints.NAME.a_m"][1] == "none"
