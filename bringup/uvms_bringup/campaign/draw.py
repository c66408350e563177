"""Distributions that a value of the scenario is drawn from, by the run's seed."""

import math
from typing import Any

from pydantic import Field, model_validator

from uvms_core.config import Config
from uvms_core.rng import generator

STREAM = "campaign.draw."
"""Each path has a random stream of its own: one more draw does not shift the others."""

FAR = 3


class Draw(Config):
    """One distribution; exactly one of its words is given."""

    uniform: tuple[float, float] | None = Field(
        None, description="least and greatest value, evenly distributed"
    )
    normal: tuple[float, float] | None = Field(
        None, description="mean and standard deviation > 0 of a normal distribution"
    )
    loguniform: tuple[float, float] | None = Field(
        None, description="least and greatest value > 0, whose logarithm is evenly distributed"
    )
    choice: tuple[Any, ...] | None = Field(
        None, min_length=1, description="values, each as likely as the others"
    )

    @model_validator(mode="after")
    def _is_a_distribution(self) -> "Draw":
        given = [name for name in type(self).model_fields if getattr(self, name) is not None]
        if len(given) != 1:
            words = ", ".join(type(self).model_fields)
            raise ValueError(f"give one of {words}; {len(given)} are given")
        for name in ("uniform", "loguniform"):
            bounds = getattr(self, name)
            if bounds is not None and not bounds[0] < bounds[1]:
                raise ValueError(f"{name}: the first value must be less than the second")
        if self.loguniform is not None and self.loguniform[0] <= 0.0:
            raise ValueError("loguniform: both values must be > 0")
        if self.normal is not None and self.normal[1] <= 0.0:
            raise ValueError("normal: the standard deviation must be > 0")
        return self

    def ends(self) -> list[tuple[str, Any]]:
        """The values that a scenario must take before any is drawn, with words for them.

        Those of a normal distribution lie `FAR` standard deviations from its mean, beyond which
        one value in 370 is.
        """
        if self.choice is not None:
            return [(f"choice {number}", one) for number, one in enumerate(self.choice, start=1)]
        if self.normal is not None:
            mean, spread = self.normal
            return [
                (f"normal, mean {sign} {FAR} standard deviations,", mean + factor * spread)
                for sign, factor in (("-", -FAR), ("+", FAR))
            ]
        name = "loguniform" if self.loguniform is not None else "uniform"
        low, high = self.loguniform or self.uniform or (0.0, 1.0)
        return [(f"the least value of {name}", low), (f"the greatest value of {name}", high)]

    def value(self, path: str, seed: int) -> Any:
        """The value of this path in the run of this seed, the same on every machine."""
        random = generator(seed, f"{STREAM}{path}")
        if self.choice is not None:
            return self.choice[int(random.integers(len(self.choice)))]
        if self.normal is not None:
            return float(random.normal(*self.normal))
        if self.loguniform is not None:
            low, high = map(math.log, self.loguniform)
            return math.exp(float(random.uniform(low, high)))
        return float(random.uniform(*(self.uniform or (0.0, 1.0))))
