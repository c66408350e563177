"""A part is found by the registry alone: no code compares its name."""

import ast

import pytest
from project import PACKAGES, ROOT, modules

from uvms_control import AllocatorConfig, ControlConfig
from uvms_core import registry
from uvms_observer import NavigationConfig, ObserverConfig
from uvms_planner import PlannerConfig

PARTS = (
    registry.NAVIGATION_FILTERS,
    registry.OBSERVERS,
    registry.PLANNERS,
    registry.CONTROLLERS,
    registry.ALLOCATORS,
)
SECTIONS = (NavigationConfig, ObserverConfig, PlannerConfig, ControlConfig, AllocatorConfig)
NAMES = {name for door in PARTS for name in registry.names(door)} - {"none"}
"""`none`, the observer, is a word with other meanings as well, such as a run without a goal."""


def compared(tree):
    """Every text that stands in a comparison or is matched by a `case`."""
    for node in ast.walk(tree):
        if isinstance(node, (ast.Compare, ast.match_case)):
            constants = (part for part in ast.walk(node) if isinstance(part, ast.Constant))
            yield from (part.value for part in constants if isinstance(part.value, str))


def test_the_names_are_there():
    assert {"paper", "genetic", "least_norm", "weighted_least_squares"} <= NAMES


@pytest.mark.parametrize("package", PACKAGES)
def test_no_name_of_a_part_is_compared(package):
    found = {
        str(file.relative_to(ROOT)): sorted(names)
        for file in modules(package)
        if (names := NAMES & set(compared(ast.parse(file.read_text(encoding="utf-8")))))
    }
    assert found == {}


@pytest.mark.parametrize("package", PACKAGES)
def test_no_name_of_a_part_is_a_literal_type(package):
    literals = [
        node
        for file in modules(package)
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Subscript)
        and isinstance(node.value, ast.Name)
        and node.value.id == "Literal"
    ]
    parts = (part for node in literals for part in ast.walk(node))
    assert not NAMES & {part.value for part in parts if isinstance(part, ast.Constant)}


@pytest.mark.parametrize("section", SECTIONS)
def test_the_default_of_every_section_is_registered_and_fits(section):
    default = section.model_fields[section.slot.field].default
    assert default in registry.names(section.slot.door)
    assert isinstance(section().part(), type)
