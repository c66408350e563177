"""What a benchmark yields: figures with what they are compared with, and targets."""

import json
import operator
from dataclasses import dataclass

_TESTS = {">=": operator.ge, "<=": operator.le}


@dataclass(frozen=True)
class Target:
    """What a figure's `ratio` or `value` should be, such as Target("ratio", ">=", 1.0)."""

    field: str
    sign: str
    bound: float

    def __str__(self) -> str:
        return f"{self.field} {self.sign} {self.bound:g}"

    def met(self, figure: "Figure") -> bool:
        """Whether the figure is as it should be; what could not be measured is not."""
        number = getattr(figure, self.field)
        return number is not None and _TESTS[self.sign](number, self.bound)


@dataclass(frozen=True)
class Figure:
    """One line of the output.

    The ratio is our value over the reference's in the same unit: for times, errors and disturbances
    less is better, for rates more.
    """

    name: str
    value: float
    unit: str
    reference: str | None = None
    ratio: float | None = None
    target: Target | None = None

    def line(self) -> str:
        """The figure as one JSON object."""
        return json.dumps(
            {
                "name": self.name,
                "value": _rounded(self.value),
                "unit": self.unit,
                "reference": self.reference,
                "ratio": _rounded(self.ratio),
                "target": None if self.target is None else str(self.target),
                "met": None if self.target is None else self.target.met(self),
            },
            ensure_ascii=False,
        )


def _rounded(number: float | None) -> float | None:
    return None if number is None else float(f"{number:.4g}")
