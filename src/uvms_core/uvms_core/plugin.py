"""Sections of a configuration that choose a part of the loop, and how that part is made.

A section such as `control` names its part (`control.law`), which the registry finds, and holds what
only that part knows (`control.parameters`), which the part's class declares as its inner
configuration `Parameters`. What a part must do is a protocol; it is checked before the part is
made, so that a mistake in a plug-in is one clear line and not a traceback in the middle of a run.
"""

import inspect
import traceback
from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import wraps
from typing import Any, ClassVar, TypeVar

from pydantic import Field, ValidationInfo, field_validator, model_validator

from uvms_core import registry
from uvms_core.config import Config, validated
from uvms_core.errors import ConfigError, PluginError, UvmsError
from uvms_core.registry import Door
from uvms_core.signals import to_seconds

OWN = "uvms_"
"""What the names of this project's packages begin with."""
HOOKS = ("inform",)
"""Methods with signals that a part may have beside those of its protocol."""
P = TypeVar("P", bound="PluginConfig")


@dataclass(frozen=True)
class Slot:
    """Where a section says which part it wants.

    Attributes:
        door: kind of the part.
        field: the section's field that names the part.
        interface: protocol that the part's class must fulfil.
    """

    door: Door
    field: str
    interface: Any


class PluginConfig(Config):
    """Base of a section whose part may be replaced.

    A section that is one word only names its part: `observer: none` is `observer: {law: none}`.
    """

    slot: ClassVar[Slot]
    words: ClassVar[Mapping[str, Mapping[str, Any]]] = {}
    """What further words stand for, such as `off`."""

    parameters: Any = Field(
        default_factory=dict,
        description="what only the chosen part knows, by name (its class lists them as Parameters)",
    )

    @model_validator(mode="before")
    @classmethod
    def _may_be_a_word(cls, section: Any) -> Any:
        return cls.spelled_out(section)

    @classmethod
    def spelled_out(cls, section: Any) -> Any:
        """The fields that a section of one word stands for; any other section as it is.

        `off` and `on` are true and false to YAML 1.1, so that false is taken for `off`.
        """
        word = "off" if section is False and "off" in cls.words else section
        if not isinstance(word, str):
            return section
        return dict(cls.words.get(word, {cls.slot.field: word}))

    @field_validator("*")
    @classmethod
    def _is_known(cls, value: Any, info: ValidationInfo) -> Any:
        """Refuse an unknown name; the default, which needs no look-up, is taken as it is."""
        field = cls.slot.field
        if info.field_name == field and value != cls.model_fields[field].default:
            try:
                registry.check(cls.slot.door, value)
            except PluginError as fault:
                raise ValueError(str(fault)) from fault
        return value

    @property
    def chosen(self) -> str:
        """Name of the part, or `module:Class`."""
        return getattr(self, self.slot.field)

    def part(self) -> type:
        """The class of the chosen part.

        Raises:
            PluginError: it cannot be imported, or does not do what such a part must do.
        """
        cls = registry.load(self.slot.door, self.chosen)
        if not isinstance(cls, type):
            raise PluginError(f"{self._label}: {cls!r} is not a class")
        for fault in _faults(cls, self.slot.interface):
            raise PluginError(f"{self._label}: {fault}")
        return cls

    def part_parameters(self) -> type[Config] | None:
        """The configuration `Parameters` of the chosen part, None where it takes none.

        Raises:
            PluginError: as `part`, or `Parameters` is not a configuration with all defaults.
        """
        model: Any = getattr(self.part(), "Parameters", None)
        if model is None:
            return None
        if not (isinstance(model, type) and issubclass(model, Config)):
            raise PluginError(f"{self._label}: its Parameters must derive from uvms_core's Config")
        if required := [n for n, field in model.model_fields.items() if field.is_required()]:
            raise PluginError(f"{self._label}: its Parameters need a default: {required[0]}")
        return model

    def resolved(self: P) -> P:
        """This section with `parameters` as the chosen part's own, defaults filled in.

        Raises:
            PluginError: as `part_parameters`, or the part takes no parameters.
            ConfigError: a parameter is unknown or outside its bounds, or the part ignores a
                section that is set.
        """
        self._refuse_ignored()
        model, given = self.part_parameters(), self.parameters
        if model is None:
            if given:
                raise PluginError(f"{self._label} takes no parameters; got {given!r}")
            return self
        if isinstance(given, model):
            return self
        own = validated(model, given, f"parameters of {self._label}", ConfigError)
        return self.model_copy(update={"parameters": own})

    def _refuse_ignored(self) -> None:
        """Refuse values in a section that the chosen part does not read.

        A part's class lists such sections as `ignores`, each with who reads it. The list is that
        of the class alone: a class derived from it may read all of them.
        """
        for section, reader in vars(self.part()).get("ignores", {}).items():
            for name in _changed(getattr(self, section)):
                raise ConfigError(
                    f"{self._label} ignores {section}.{name}: the section {section} is for"
                    f" {reader}. Leave it out, or choose another {self.slot.field}"
                )

    @property
    def _label(self) -> str:
        return f"{self.slot.door.what} {self.chosen!r}"


def _changed(section: Config) -> Iterator[str]:
    """Fields of a section that are not at their defaults.

    By value: ROS parameters and the configuration in a log set every field.
    """
    for name, field in type(section).model_fields.items():
        if getattr(section, name) != field.get_default(call_default_factory=True):
            yield name


def create(config: PluginConfig, first: Any, *others: Any) -> Any:
    """The part that a section chooses, made as `cls(first, config, *others)`.

    Raises:
        PluginError: it cannot be found, does not fit, or its constructor fails.
        ConfigError: one of its parameters is wrong.
    """
    cls, config = config.part(), config.resolved()
    label = f"{config.slot.door.what} {config.chosen!r}"
    arguments = (first, config, *others)
    try:
        return _isolated(cls(*arguments), config.slot.interface)
    except UvmsError:
        raise
    except (Exception, SystemExit) as fault:  # a plug-in may raise anything
        where = traceback.extract_tb(fault.__traceback__)[-1]
        raise PluginError(
            f"{label}: {cls.__name__}({', '.join(map(_kind, arguments))}) failed:"
            f" {type(fault).__name__}: {fault} ({where.filename}:{where.lineno})"
        ) from fault


def prepared(part: Any, period: int) -> Any:
    """The part, told the control period (ns) by its method `prepare`, in s, where it has one."""
    if prepare := getattr(part, "prepare", None):
        prepare(to_seconds(period))
    return part


def _isolated(part: Any, interface: Any) -> Any:
    """A part of somebody else's gets copies of what it is called with.

    In one process all parts share their signals, and the log is written from them: a part that
    writes into an array would change what the others see and what the log says has happened.
    """
    if type(part).__module__.startswith(OWN):
        return part
    own = [
        name
        for name, wanted in vars(interface).items()
        if inspect.isfunction(wanted) and not name.startswith("_")
    ]
    for name in (*own, *(hook for hook in HOOKS if hasattr(part, hook))):
        setattr(part, name, _with_copies(getattr(part, name)))
    return part


def _with_copies(method: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(method)
    def call(*arguments: Any, **named: Any) -> Any:
        return method(*deepcopy(arguments), **deepcopy(named))

    return call


def _faults(cls: type, interface: Any) -> Iterator[str]:
    """What a class lacks of a protocol: methods, or arguments that they take."""
    missing: frozenset[str] = getattr(cls, "__abstractmethods__", frozenset())
    for name, wanted in vars(interface).items():
        if name.startswith("_") or not inspect.isfunction(wanted):
            continue
        call = f"{name}({', '.join(list(inspect.signature(wanted).parameters)[1:])})"
        own = getattr(cls, name, None)
        if name in missing or not callable(own):
            yield f"{cls.__name__} has no method {call}"
            continue
        try:
            inspect.signature(own).bind(*inspect.signature(wanted).parameters)
        except TypeError as fault:
            yield f"{cls.__name__}.{name} is called as {call}: {fault}"


def _kind(argument: Any) -> str:
    return type(argument).__name__
