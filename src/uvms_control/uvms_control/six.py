"""Types of fields with one value per axis: surge, sway, heave, roll, pitch, yaw."""

from typing import Annotated

from pydantic import Field

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
SixPositive = Annotated[tuple[Positive, ...], Field(min_length=6, max_length=6)]
SixNotNegative = Annotated[tuple[NotNegative, ...], Field(min_length=6, max_length=6)]
