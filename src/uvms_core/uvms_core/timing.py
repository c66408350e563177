"""The period of the control loop, which plant and nodes must agree on."""

from typing import Annotated

from pydantic import Field

CONTROL_PERIOD_S = 0.05

ControlPeriod = Annotated[
    float,
    Field(
        gt=0.0,
        le=1.0,
        description="period of the control loop, a multiple of the plant's step_s, s",
    ),
]
"""Type of every field that holds it."""
