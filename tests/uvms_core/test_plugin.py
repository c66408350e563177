"""A part that does not fit is refused in one line that says what is wrong with it."""

import sys
from abc import abstractmethod
from types import ModuleType
from typing import ClassVar, Protocol

import pytest
from pydantic import Field

from uvms_core import registry
from uvms_core.config import Config
from uvms_core.errors import ConfigError, PluginError, UvmsError
from uvms_core.plugin import PluginConfig, Slot, create


class Filter(Protocol):
    @abstractmethod
    def step(self, stamp: int, value: float) -> float: ...

    def reset(self) -> str:
        return "as inherited"


class Inner(Config):
    width: float = 1.0
    names: tuple[str, ...] = ()


class FilterConfig(PluginConfig):
    slot: ClassVar[Slot] = Slot(registry.CONTROLLERS, "law", Filter)

    law: str = Field("default", description="of the test")
    limit: float = 3.0
    inner: Inner = Inner()


class Good:
    class Parameters(Config):
        gain: float = Field(2.0, gt=0.0, le=10.0)

    def __init__(self, vehicle, config):
        self.vehicle, self.config = vehicle, config

    def step(self, stamp, value, extra=None):
        return self.config.parameters.gain * value

    def reset(self):
        return "own"


class Derived(Filter):
    def __init__(self, vehicle, config, seed):
        self.seed = seed

    def step(self, stamp, value):
        return value


class NoStep(Filter):
    pass


class OtherStep(Derived):
    def step(self, stamp):
        return stamp


class NoDefault(Derived):
    class Parameters(Config):
        gain: float


class WrongParameters(Derived):
    Parameters = dict


class OtherConstructor(Good):
    def __init__(self, vehicle):
        pass


class FailingConstructor(Good):
    def __init__(self, vehicle, config):
        self.value = 1.0 / 0.0


class RefusingConstructor(Good):
    def __init__(self, vehicle, config):
        raise UvmsError("the vehicle has no arm")


class Narrow(Good):
    ignores: ClassVar = {"inner": "others"}


class WideAgain(Narrow):
    pass


def function(vehicle, config):
    return Good(vehicle, config)


@pytest.fixture(autouse=True)
def _importable(monkeypatch):
    """This file as a module that a configuration can name."""
    module = ModuleType("my_parts")
    vars(module).update(globals())
    monkeypatch.setitem(sys.modules, "my_parts", module)


def section(name: str, **values) -> FilterConfig:
    return FilterConfig(law=f"my_parts:{name}", **values)


def test_a_part_is_made_with_its_section_and_its_own_parameters():
    part = create(section("Good", limit=5.0, parameters={"gain": 4}), "vehicle")
    assert (part.vehicle, part.config.limit, part.config.parameters.gain) == ("vehicle", 5.0, 4.0)
    assert part.step(0, 2.0) == 8.0
    assert create(section("Good"), "vehicle").config.parameters.gain == 2.0


def test_a_part_may_inherit_from_the_protocol_and_take_more_arguments():
    part = create(section("Derived"), "vehicle", 7)
    assert (part.seed, part.reset(), part.step(0, 3.0)) == (7, "as inherited", 3.0)


def test_resolved_parameters_are_written_out_and_read_again():
    found = section("Good", parameters={"gain": 4.5}).resolved()
    written = found.model_dump(mode="json")
    assert written["parameters"] == {"gain": 4.5}
    assert FilterConfig.model_validate(written).resolved() == found
    assert found.resolved() is found


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("NoStep", "control law 'my_parts:NoStep': NoStep has no method step(stamp, value)"),
        ("OtherStep", "OtherStep.step is called as step(stamp, value): too many positional"),
        ("Missing", "cannot import my_parts:Missing: AttributeError"),
        ("function", "is not a class"),
        ("NoDefault", "its Parameters need a default: gain"),
        ("WrongParameters", "its Parameters must derive from uvms_core's Config"),
    ],
)
def test_a_part_that_does_not_fit_is_refused_before_it_is_made(name, message):
    with pytest.raises(PluginError) as caught:
        section(name).resolved()
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("OtherConstructor", "OtherConstructor(str, FilterConfig) failed: TypeError"),
        ("FailingConstructor", "failed: ZeroDivisionError: float division by zero ("),
    ],
)
def test_a_constructor_that_fails_is_one_line_with_the_place(name, message):
    with pytest.raises(PluginError) as caught:
        create(section(name), "vehicle")
    assert message in str(caught.value)
    assert "test_plugin.py:" in str(caught.value) or "plugin.py:" in str(caught.value)


def test_an_error_of_the_project_s_own_tree_passes_as_it_is():
    with pytest.raises(UvmsError, match=r"^the vehicle has no arm$"):
        create(section("RefusingConstructor"), "vehicle")


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"gain": 11.0}, "gain: Input should be less than or equal to 10 (got 11.0)"),
        ({"speed": 1.0}, "speed: Extra inputs are not permitted; known names here: gain"),
        (3, "write a group of values, {NAME: VALUE}, with names of gain (got 3)"),
    ],
)
def test_wrong_parameters_name_the_part_the_value_and_what_is_allowed(parameters, message):
    with pytest.raises(ConfigError) as caught:
        section("Good", parameters=parameters).resolved()
    assert "parameters of control law 'my_parts:Good'" in str(caught.value)
    assert message in str(caught.value)


def test_a_section_that_the_part_ignores_is_refused_where_it_is_set():
    with pytest.raises(ConfigError) as caught:
        section("Narrow", inner={"width": 2.0}).resolved()
    assert str(caught.value) == (
        "control law 'my_parts:Narrow' ignores inner.width: the section inner is for others."
        " Leave it out, or choose another law"
    )
    for fine in (section("Narrow", inner={"width": 1.0}), section("WideAgain", inner={"width": 2})):
        assert fine.resolved().inner == fine.inner


def test_a_part_without_parameters_takes_none():
    with pytest.raises(PluginError, match=r"takes no parameters; got \{'gain': 1\.0\}"):
        section("Derived", parameters={"gain": 1.0}).resolved()


@pytest.mark.parametrize("name", ["pid", "my_parts", "my_parts:", ":Good", "my parts:Good", ""])
def test_an_unknown_name_lists_the_choices(name):
    with pytest.raises(
        ValueError, match=r"is unknown; choose one of .*default, paper.*my_module:MyClass"
    ):
        FilterConfig(law=name)


@pytest.mark.parametrize("source", ["1 / 0", "import no_such_module", "def f(:"])
def test_a_module_that_cannot_be_imported_is_one_line(source, tmp_path, monkeypatch):
    module = f"broken_{abs(hash(source))}"
    (tmp_path / f"{module}.py").write_text(source)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(PluginError, match=rf"cannot import {module}:Law: \w+Error: "):
        registry.load(registry.CONTROLLERS, f"{module}:Law")


def test_what_is_registered_can_be_loaded():
    doors = (registry.NAVIGATION_FILTERS, registry.OBSERVERS, registry.PLANNERS)
    for door in (*doors, registry.CONTROLLERS, registry.ALLOCATORS):
        assert registry.names(door)
        for name in registry.names(door):
            assert isinstance(registry.load(door, name), type)
