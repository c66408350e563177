"""ROS parameters from a configuration's fields: name, type, default, bounds, description."""

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Annotated, Any, TypeVar, get_args, get_origin

import annotated_types
from pydantic import BaseModel
from pydantic.fields import FieldInfo
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from uvms_core.config import Config, models_in, validated
from uvms_core.errors import ConfigError
from uvms_core.plugin import PluginConfig
from uvms_core.yaml_text import parse_yaml

C = TypeVar("C", bound=Config)
Lookup = Callable[[str, Any, FieldInfo], Any]
"""Value of a parameter by its name, the default and the field; None where it is not set."""
PARAMETERS = "parameters"
"""Field of a section under which stands what only the chosen part knows."""
UNTYPED: tuple[Any, ...] = ((), None)
"""Values that have no type in ROS; a parameter that is not set stands for them."""


def declare_config(node: Node, model: type[C]) -> C:
    """Declare every field of `model` (nested ones with dots) and return the validated values.

    Where the model chooses a part by name, the parameters of the part that is chosen are declared
    under `parameters`.

    Raises:
        ConfigError: a value is outside its bounds; the message names it and what is allowed.
        PluginError: a part that is chosen cannot be found.
    """

    def declared(name: str, default: Any, field: FieldInfo) -> Any:
        if not node.has_parameter(name):
            _declare_field(node, name, default, field)
        return node.get_parameter_or(name).value

    return _configured(model, declared, f"parameters of {node.get_name()}")


def config_of(model: type[C], given: Mapping[str, Any], whose: str) -> C:
    """The configuration that the parameters of another node say, by name; defaults for the rest.

    Raises:
        ConfigError: a value is outside its bounds, in an error that begins with `whose`.
        PluginError: a part that is chosen cannot be found.
    """
    return _configured(model, lambda name, default, field: given.get(name), whose)


def _configured(model: type[C], value_of: Lookup, whose: str) -> C:
    """The configuration whose values somebody looks up, those of the chosen part included."""
    values: dict[str, Any] = {}
    _collect(model(), (), value_of, values)
    config = validated(model, values, whose)
    if isinstance(config, PluginConfig) and (own := config.part_parameters()) is not None:
        _collect(own(), (PARAMETERS,), value_of, values)
        config = validated(model, values, whose)
    return config


def flatten(config: Config) -> dict[str, Any]:
    """A configuration as ROS parameter names and values, for a parameter file.

    Empty lists and None are left out: ROS cannot tell their type, and they are the defaults. Maps,
    and lists of sections or of lists, are JSON.
    """
    leaves = _leaves(_resolved(config))
    return {
        ".".join(path): _to_ros(value, field)
        for path, field, value in leaves
        if value not in UNTYPED
    }


def describe(*models: type[Config]) -> str:
    """The parameters of configurations as text: name, default, bounds and meaning, a line each."""
    lines = []
    for model in models:
        for path, field, default in _leaves(_resolved(model())):
            bounds = [b for b in _bounds(field) if b is not None]
            within = f", {bounds[0]:g} to {bounds[1]:g}" if len(bounds) == 2 else ""
            name = ".".join(path)
            shown = list(default) if isinstance(default, tuple) else default
            lines.append(f"  {name} ({shown}{within})\n      {field.description or ''}")
        if issubclass(model, PluginConfig):
            meaning = model.model_fields[PARAMETERS].description
            lines.append(f"  {PARAMETERS}.NAME\n      {meaning}")
    return "\n".join(lines)


def _collect(
    defaults: BaseModel, prefix: tuple[str, ...], value_of: Lookup, values: dict[str, Any]
) -> None:
    """Store in `values` what the fields of a section are set to."""
    for path, field, default in _leaves(defaults, prefix):
        name = ".".join(path)
        value = value_of(name, default, field)
        if value is not None:
            _store(values, path, _from_text(name, value) if _is_text(field) else value)


def _resolved(config: Config) -> Config:
    return config.resolved() if isinstance(config, PluginConfig) else config


def _declare_field(node: Node, name: str, default: Any, field: FieldInfo) -> None:
    if default in UNTYPED and not _is_text(field):
        kind = Parameter.Type.DOUBLE_ARRAY if _is_array(field.annotation) else Parameter.Type.DOUBLE
        node.declare_parameter(name, kind, _descriptor(field))
    else:
        node.declare_parameter(name, _to_ros(default, field), _descriptor(field))


def _leaves(
    values: BaseModel, prefix: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], FieldInfo, Any]]:
    for name, field in type(values).model_fields.items():
        value = getattr(values, name)
        if isinstance(value, BaseModel):
            yield from _leaves(value, (*prefix, name))
        elif not (isinstance(values, PluginConfig) and name == PARAMETERS):  # those of no part
            yield (*prefix, name), field, value


def _is_array(annotation: Any) -> bool:
    """Whether an annotation such as `tuple[float, ...] | None` is that of a list."""
    return get_origin(annotation) is tuple or any(map(_is_array, get_args(annotation)))


def _is_text(field: FieldInfo) -> bool:
    """Whether the parameter is a text in YAML or JSON, since ROS has no type for the field.

    Maps, and lists of sections or of lists.
    """
    annotation = field.annotation
    if get_origin(annotation) is not tuple:
        return get_origin(annotation) is dict
    return next(models_in(annotation), None) is not None or _holds_lists(annotation)


def _holds_lists(annotation: Any) -> bool:
    inner = (get_args(each)[0] if get_origin(each) is Annotated else each
             for each in get_args(annotation))  # fmt: skip
    return any(get_origin(each) is tuple for each in inner)


def _from_text(name: str, value: Any) -> Any:
    return parse_yaml(value, name, ConfigError) if isinstance(value, str) and value else ()


def _to_ros(value: Any, field: FieldInfo) -> Any:
    if _is_text(field):
        return json.dumps(_plain(value))
    if isinstance(value, (tuple, list)):
        numbers = all(isinstance(item, (int, float)) for item in value)
        return [float(item) if numbers else item for item in value]
    return value


def _plain(value: Any) -> Any:
    """Nested maps, lists and numbers, without what is at its default."""
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json", exclude_unset=True)
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items()}
    return [_plain(each) for each in value] if isinstance(value, tuple | list) else value


def _descriptor(field: FieldInfo) -> ParameterDescriptor:
    descriptor = ParameterDescriptor(description=field.description or "", read_only=True)
    low, high = _bounds(field)
    if low is not None and high is not None:
        if field.annotation is float:
            descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
        elif field.annotation is int:
            whole = IntegerRange(from_value=int(low), to_value=int(high), step=1)
            descriptor.integer_range = [whole]
    return descriptor


def _bounds(field: FieldInfo) -> tuple[float | None, float | None]:
    low = high = None
    for item in field.metadata:
        if isinstance(item, annotated_types.Ge):
            low = float(str(item.ge))
        if isinstance(item, annotated_types.Le):
            high = float(str(item.le))
    return low, high


def _store(values: dict[str, Any], path: tuple[str, ...], value: Any) -> None:
    for part in path[:-1]:
        values = values.setdefault(part, {})
    is_array = hasattr(value, "tolist") or isinstance(value, tuple)
    values[path[-1]] = list(value) if is_array else value
