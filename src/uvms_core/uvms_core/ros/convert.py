"""Nested dicts of plain values to rclpy messages; `uvms_core.messages` does the rest."""

from functools import cache
from importlib import import_module
from typing import Any

from rosidl_parser.definition import AbstractNestedType, NamespacedType

from uvms_core.errors import DefinitionError
from uvms_core.topics import Action, Topic


@cache
def interface_class(type_name: str) -> Any:
    """The class of `package/msg/Name`, `package/srv/Name` or `package/action/Name`.

    Raises:
        DefinitionError: its package is not installed, or has no such type.
    """
    package, kind, name = type_name.split("/")
    try:
        return getattr(import_module(f"{package}.{kind}"), name)
    except (ImportError, AttributeError) as fault:
        raise DefinitionError(
            f"{type_name} is not installed: source the ROS workspace that has {package}, before"
            f" the nodes start ({fault})"
        ) from fault


def message_class(topic: Topic) -> Any:
    """The message class of a topic."""
    return interface_class(topic.type)


def action_class(action: Action) -> Any:
    """The action class of an action."""
    return interface_class(action.type)


def to_ros(cls: Any, data: dict[str, Any]) -> Any:
    """A message of class `cls` filled from a nested dict."""
    return _fill(cls(), data)


def _fill(msg: Any, data: dict[str, Any]) -> Any:
    for name, value in data.items():
        if isinstance(value, dict):
            _fill(getattr(msg, name), value)
        elif isinstance(value, (list, tuple)) and value and isinstance(value[0], dict):
            kind: Any = type(msg)
            element = _element_class(kind, name)
            setattr(msg, name, [_fill(element(), item) for item in value])
        else:
            setattr(msg, name, value)
    return msg


@cache
def _element_class(cls: Any, name: str) -> Any:
    slot = cls.SLOT_TYPES[list(cls.get_fields_and_field_types()).index(name)]
    if not isinstance(slot, AbstractNestedType) or not isinstance(slot.value_type, NamespacedType):
        raise TypeError(f"{cls.__name__}.{name} is not a sequence of messages")
    return interface_class("/".join(slot.value_type.namespaced_name()))
