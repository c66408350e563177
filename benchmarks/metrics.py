"""What a benchmark yields: metrics with their references and targets."""

import json
import operator
from dataclasses import dataclass

_TESTS = {">=": operator.ge, "<=": operator.le}


@dataclass(frozen=True)
class Target:
    """What a metric's `ratio` or `value` should be, such as Target("ratio", ">=", 1.0)."""

    field: str
    sign: str
    bound: float

    def __str__(self) -> str:
        return f"{self.field} {self.sign} {self.bound:g}"

    def met(self, metric: "Metric") -> bool:
        """Whether the metric meets the target; one that could not be measured does not."""
        number = getattr(metric, self.field)
        return number is not None and _TESTS[self.sign](number, self.bound)


@dataclass(frozen=True)
class Metric:
    """One line of the output.

    The ratio is our value over the reference's in the same unit: lower is better
    for times, errors and disturbances, higher for rates.
    """

    name: str
    value: float
    unit: str
    reference: str | None = None
    ratio: float | None = None
    target: Target | None = None

    def line(self) -> str:
        """The metric as one JSON object."""
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
