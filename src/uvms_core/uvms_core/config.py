"""The base of every configuration: each parameter is declared once, with unit, bounds and meaning.

A configuration is a frozen pydantic model. Files, `--set PATH=VALUE` and ROS parameters all derive
from its fields, so that a gain has one name, one default and one description.
"""

from collections.abc import Iterator
from typing import get_args

from pydantic import BaseModel, ConfigDict, ValidationError

from uvms_core.errors import ConfigError, UvmsError

_LONGEST_ECHO = 120  # characters of a wrong value that an error repeats
_MOST_FAULTS = 50  # lines of an error; a table in the wrong place has thousands


class Config(BaseModel):
    """Base of all configurations: frozen, known names only, finite numbers only."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, validate_default=True, allow_inf_nan=False
    )

    @classmethod
    def field_model(cls, name: str) -> type[BaseModel] | None:
        """The model that a field of this name holds, alone or in a sequence; None for others."""
        return _inner_model(getattr(cls.model_fields.get(name), "annotation", None))


def explain(error: ValidationError, what: str, model: type[BaseModel]) -> str:
    """One line per fault: the field, the value, and what is allowed."""
    items = error.errors(include_url=False, include_context=False)
    places = {item["loc"][:k] for item in items for k in range(len(item["loc"]))}
    shown = [item for item in items if not _follows_from_others(item, places)]
    lines = [_explain_one(item, what, model) for item in shown[:_MOST_FAULTS]]
    if more := len(shown) - len(lines):
        lines.append(f"{what}: and {more} more faults")
    return "\n".join(lines)


def _follows_from_others(item, groups: set[tuple]) -> bool:
    """Whether a list is only called too short because of faults of its own values.

    groups: places that have a fault inside.
    """
    return item["type"] == "too_short" and item["loc"] in groups


def _explain_one(item, what: str, model: type[BaseModel]) -> str:
    path = ".".join(str(part) for part in item["loc"] if not _is_tag(part)) or "(top)"
    line = f"{what}: {path}: {item['msg'].removeprefix('Value error, ')}"
    if item["type"] == "model_type":
        names = ", ".join(_names_at(model, item["loc"]))
        line = f"{what}: {path}: write a group of values, {{NAME: VALUE}}, with names of {names}"
    if item["type"] == "extra_forbidden":
        return f"{line}; known names here: {', '.join(_names_at(model, item['loc'][:-1]))}"
    if item["type"] == "missing":
        return line
    got = _echo(item["input"])
    return line if got is None else f"{line} (got {got})"


def _echo(value) -> str | None:
    """The value as a message repeats it; None for a section, and for one that is too long."""
    if isinstance(value, dict | BaseModel):
        return None
    try:
        text = repr(value)
    except ValueError:  # an integer of more digits than Python writes
        return None
    return text if len(text) <= _LONGEST_ECHO else None


def _is_tag(part: object) -> bool:
    """Whether a part of a place is the tag of one of several models, `<Model>`, and no field."""
    return isinstance(part, str) and part.startswith("<")


def _names_at(model: type[BaseModel], path: tuple) -> list[str]:
    for k, part in enumerate(path):
        tagged = [after for after in path[k + 1 : k + 3] if _is_tag(after)]
        field = model.model_fields.get(str(part))
        inner = None
        if tagged and field is not None:
            inner = next(
                (m for m in models_in(field.annotation) if f"<{m.__name__}>" in tagged), None
            )
        elif issubclass(model, Config):
            inner = model.field_model(str(part))
        model = inner or model
    return sorted(model.model_fields)


def models_in(annotation) -> Iterator[type[BaseModel]]:
    """All models in an annotation such as `M`, `M | None` or `tuple[A | B, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from models_in(argument)


def _inner_model(annotation) -> type[BaseModel] | None:
    """The model in an annotation such as `M`, `M | None` or `tuple[M, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    inner = (_inner_model(argument) for argument in get_args(annotation))
    return next(filter(None, inner), None)


def validated(model: type[BaseModel], data, what: str, error: type[UvmsError] = ConfigError):
    """`model` made from `data`, or one clear error that lists every fault."""
    try:
        return model.model_validate(data)
    except ValidationError as fault:
        raise error(explain(fault, what, model)) from fault
