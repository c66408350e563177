"""Pages that list every field of a vehicle file and of a scenario, made from the models.

`python -m uvms_bringup.fields --output docs` writes the pages of the documentation.
"""

import inspect
import types
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import annotated_types
from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from uvms_bringup.scenario import Scenario
from uvms_core.config import models_in
from uvms_core.plugin import PluginConfig
from uvms_core.sensors import sensor_type
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Sensors
from uvms_core.yaml_text import dump_yaml

FURTHER_SENSORS = ("depth", "heading", "magnetometer", "position_fix", "target_marker")
"""Sensors that come with the project, of which a vehicle file need not have a section."""

PLAIN = {float: "number", int: "whole number", str: "text", bool: "true or false", Any: "value"}
BOUNDS = (
    (annotated_types.Gt, "gt", ">"),
    (annotated_types.Ge, "ge", "≥"),
    (annotated_types.Lt, "lt", "<"),
    (annotated_types.Le, "le", "≤"),
)
LONGEST_DEFAULT = 60  # characters

INTRODUCTION = """<!-- Made by `uvms fields --output docs` from the models of the program. -->

# Every field of a {what}

{text}

A value outside its bounds, an unknown field and a key that is given twice are refused, with a
message.
"""
VEHICLE_TEXT = """A vehicle file is YAML 1.2. `src/uvms_core/uvms_core/vehicles/reference_auv.yaml`
is an example with comments. One value is changed for a run by `--set vehicle.PATH=VALUE`, such as
`--set vehicle.hull.mass_kg=190`; an item of a list is named by its `name` or by its number:
`--set vehicle.thrusters.main.limit_n=80`."""
SCENARIO_TEXT = """A scenario is YAML 1.2. `bringup/config/scenarios` has examples. One value is
changed for a run by `--set PATH=VALUE`, such as `--set control.observer=false`. Fields that belong
to one part of the loop only, such as one control law, are below `parameters` of its section."""


def vehicle_page() -> str:
    """The fields of a vehicle file, as Markdown."""
    return _page("vehicle file", VEHICLE_TEXT, Vehicle, None)


def scenario_page() -> str:
    """The fields of a scenario, as Markdown."""
    defaults = Scenario(scenario="my_scenario", duration_s=1.0)
    return _page("scenario", SCENARIO_TEXT, Scenario, defaults)


def _page(what: str, text: str, model: type[BaseModel], defaults: BaseModel | None) -> str:
    sections = "\n".join(_sections(model, defaults, "", ""))
    return INTRODUCTION.format(what=what, text=" ".join(text.split())) + "\n" + sections


def _sections(
    model: type[BaseModel], defaults: BaseModel | None, path: str, note: str
) -> Iterator[str]:
    """A table of the section's own fields, then the sections inside it."""
    title = f"`{path}`" if path else "Top level"
    yield f"## {title}\n\n{_summary(model)}{note}\n\n{_table(model, defaults, path)}"
    for name, field in model.model_fields.items():
        models = list(models_in(field.annotation))
        value = _default(field, name, defaults)
        if isinstance(value, BaseModel) and not models:  # such as the parameters of a part
            models = [type(value)]
        own = value if isinstance(value, BaseModel) else None
        for inner in models:
            yield from _sections(inner, own, _inside(path, name, field, inner), _note(field))
    if model is Sensors:
        for name in FURTHER_SENSORS:
            section = sensor_type(name).section
            yield from _sections(section, None, _joined(path, name), " The section is optional.")


def _table(model: type[BaseModel], defaults: BaseModel | None, path: str) -> str:
    lines = ["| Field | Type | Default | Bounds | Meaning |", "|---|---|---|---|---|"]
    for name, field in model.model_fields.items():
        cells = (
            f"`{_joined(path, name)}`",
            _type(field.annotation),
            _default_text(field, name, defaults),
            _bounds(field),
            field.description or _summary(_model_in(field.annotation)),
        )
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def _summary(model: type[BaseModel] | None) -> str:
    """First paragraph of the model's own docstring."""
    text = inspect.cleandoc((model and model.__doc__) or "").split("\n\n")[0]
    return " ".join(text.split())


def _note(field: FieldInfo) -> str:
    if type(None) in get_args(field.annotation):
        return " The section is optional."
    return ""


def _joined(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _inside(path: str, name: str, field: FieldInfo, inner: type[BaseModel]) -> str:
    """Path of a section; one item of a list stands for all."""
    whole = _joined(path, name)
    if inner in (field.annotation, type(field.default)) or type(None) in get_args(field.annotation):
        return whole
    if _is_list(field.annotation):
        return f"{whole}.NAME" if "name" in inner.model_fields else f"{whole}.0"
    return whole


def _is_list(annotation: Any) -> bool:
    if get_origin(annotation) is Annotated:
        return _is_list(get_args(annotation)[0])
    return get_origin(annotation) is tuple


def _model_in(annotation: Any) -> type[BaseModel] | None:
    """The model in an annotation such as `M`, `M | None` or `tuple[M, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    inner = (_model_in(argument) for argument in get_args(annotation))
    return next(filter(None, inner), None)


def _type(annotation: Any) -> str:
    """The type in words."""
    if annotation in PLAIN:
        return PLAIN[annotation]
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return _section_type(annotation)
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _type(arguments[0])
    if origin is Literal:
        return " or ".join(f"`{choice}`" for choice in arguments)
    if origin in (Union, types.UnionType):
        names = (_type(each) for each in arguments if each is not type(None))
        return " or ".join(dict.fromkeys(names))
    if origin is dict:
        return f"map from name to {_type(arguments[1])}"
    if origin is tuple:
        return _list_type(arguments)
    return str(getattr(annotation, "__name__", annotation))


def _section_type(model: type[BaseModel]) -> str:
    """A section, and what a single word in its place names."""
    if not issubclass(model, PluginConfig):
        return "section"
    words = "".join(f", or `{word}`" for word in model.words)
    return f"section, or a word: its `{model.slot.field}`{words}"


def _list_type(items: tuple[Any, ...]) -> str:
    inner = _plural(_type(items[0]))
    return f"list of {inner}" if items[-1] is Ellipsis else f"{len(items)} {inner}"


def _plural(name: str) -> str:
    if " or " in name:
        return f"values, each {name}"
    first, _, rest = name.partition(" of ")
    return f"{first}s of {rest}" if rest else f"{name}s"


def _default(field: FieldInfo, name: str, defaults: BaseModel | None) -> Any:
    """The value where the file gives none; `PydanticUndefined` where it must."""
    value = field.get_default(call_default_factory=True, validated_data={})
    if defaults is not None and (value is not PydanticUndefined or _is_fixed(defaults)):
        return getattr(defaults, name)
    return value


def _is_fixed(defaults: BaseModel) -> bool:
    """Whether these are default values of a section, and not an example of the whole."""
    return not isinstance(defaults, Scenario)


def _default_text(field: FieldInfo, name: str, defaults: BaseModel | None) -> str:
    value = _default(field, name, defaults)
    if value is PydanticUndefined:
        return "required"
    if isinstance(value, BaseModel) or _holds_models(value):
        return "see below"
    if value is None or value == {} or value == ():
        return "none"
    plain = list(value) if isinstance(value, tuple) else value
    text = dump_yaml([plain], default_flow_style=True, width=1000).strip()[1:-1]
    return f"`{text}`" if len(text) <= LONGEST_DEFAULT else f"{len(plain)} values"


def _holds_models(value: Any) -> bool:
    return isinstance(value, tuple) and any(isinstance(item, BaseModel) for item in value)


def _bounds(field: FieldInfo) -> str:
    """Limits of the value, of each value of a list, and of the list's length."""
    own = _limits(field.metadata)
    inner = sorted({text for text in _inner_limits(field.annotation) if text})
    length = _length(field.metadata)
    return "; ".join(filter(None, (own, *(f"each {text}" for text in inner), length)))


def _inner_limits(annotation: Any) -> Iterator[str]:
    for argument in get_args(annotation):
        if get_origin(argument) is Annotated:
            metadata = [
                item
                for each in argument.__metadata__
                for item in (each.metadata if isinstance(each, FieldInfo) else [each])
            ]
            yield _limits(metadata)
        yield from _inner_limits(argument)


def _limits(metadata: Sequence[Any]) -> str:
    parts = [
        f"{sign} {_number(getattr(item, attribute))}"
        for kind, attribute, sign in BOUNDS
        for item in metadata
        if isinstance(item, kind)
    ]
    return ", ".join(parts)


def _number(value: float) -> str:
    return str(value) if isinstance(value, int) else f"{value:g}"


def _length(metadata: Sequence[Any]) -> str:
    low = next((m.min_length for m in metadata if isinstance(m, annotated_types.MinLen)), 0)
    high = next((m.max_length for m in metadata if isinstance(m, annotated_types.MaxLen)), None)
    if low and low == high:
        return f"length {low}"
    parts = (f"length ≥ {low}" if low else "", f"length ≤ {high}" if high else "")
    return ", ".join(filter(None, parts))


PAGES = {"fields-vehicle.md": vehicle_page, "fields-scenario.md": scenario_page}


def write_pages(folder: str | None) -> int:
    """Write the pages to a folder, or print them where there is none; returns the exit code 0."""
    for name, page in PAGES.items():
        if folder is None:
            print(page())
        else:
            Path(folder).mkdir(parents=True, exist_ok=True)
            (Path(folder) / name).write_text(page(), encoding="utf-8")
            print(Path(folder) / name)
    return 0


def main(arguments: Sequence[str] | None = None) -> int:
    """`python -m uvms_bringup.fields [--output DIR]`."""
    parser = ArgumentParser(description="List every field of a vehicle file and of a scenario.")
    parser.add_argument("--output", metavar="DIR", help="folder to write the pages to")
    return write_pages(parser.parse_args(arguments).output)


if __name__ == "__main__":
    raise SystemExit(main())
