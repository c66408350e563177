"""Bounds on the fields of a run's summary, and whether a run keeps them."""

from collections.abc import Mapping
from math import isnan
from typing import Any

from pydantic import Field, model_validator

from uvms_core.config import Config

OUTCOME = "outcome"
"""The field that is required to be `completed` unless a campaign says otherwise."""

Scalar = bool | int | float | str | None


class Bound(Config):
    """What a field of the summary must be: all that is given holds."""

    min: float | None = Field(None, description="least value that is allowed")
    max: float | None = Field(None, description="greatest value that is allowed")
    equals: Scalar = Field(None, description="the value that it must have")
    one_of: tuple[Scalar, ...] | None = Field(
        None, min_length=1, description="values of which it must have one"
    )

    @model_validator(mode="after")
    def _says_something(self) -> "Bound":
        if not self.model_fields_set:
            raise ValueError("give at least one of min, max, equals, one_of")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise ValueError(f"min {self.min:g} is greater than max {self.max:g}")
        return self

    @property
    def is_numeric(self) -> bool:
        """Whether it asks for a number within limits."""
        return self.min is not None or self.max is not None

    def excess(self, value: float) -> float:
        """How far a number is beyond the nearest limit: > 0 outside, <= 0 inside."""
        beyond = [-float("inf")]
        if self.max is not None:
            beyond.append(value - self.max)
        if self.min is not None:
            beyond.append(self.min - value)
        return max(beyond)

    def fault(self, name: str, value: Any) -> str:
        """Why a value does not keep the bound; empty where it does."""
        if self.is_numeric:
            if isinstance(value, bool) or not isinstance(value, int | float):
                return f"{name} is {_shown(value)}, and must be {self}"
            if isnan(value) or self.excess(value) > 0.0:
                return f"{name} is {value:.4g}, and must be {self}"
        if "equals" in self.model_fields_set and not _same(value, self.equals):
            return f"{name} is {_shown(value)}, and must be {self}"
        if self.one_of is not None and not any(_same(value, one) for one in self.one_of):
            return f"{name} is {_shown(value)}, and must be {self}"
        return ""

    def __str__(self) -> str:
        words = [f">= {self.min:g}"] if self.min is not None else []
        words += [f"<= {self.max:g}"] if self.max is not None else []
        words += [_shown(self.equals)] if "equals" in self.model_fields_set else []
        words += [" or ".join(map(_shown, self.one_of))] if self.one_of is not None else []
        return " and ".join(words)


def _same(value: Any, wanted: Any) -> bool:
    """True is not 1 here."""
    return value == wanted and isinstance(value, bool) == isinstance(wanted, bool)


def _shown(value: Any) -> str:
    return "not known" if value is None else str(value)


def faults(required: Mapping[str, Bound], values: Mapping[str, Any]) -> list[str]:
    """Every requirement that flat summary values (dotted names) do not keep, in words."""
    checked = (bound.fault(name, values.get(name)) for name, bound in required.items())
    return [text for text in checked if text]
