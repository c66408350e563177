"""One thruster of the vehicle."""

from pydantic import Field

from uvms_core.vehicle.parts import Part, UnitVector, Vector3


class Thruster(Part):
    """A fixed thruster that pushes in both directions, with first-order lag and slew limit."""

    name: str = Field(
        min_length=1, description="name of the thruster in messages, logs and overrides"
    )
    position_m: Vector3 = Field(description="point where the thrust acts, body frame, m")
    direction: UnitVector = Field(
        description="direction of positive thrust on the vehicle, body frame"
    )
    limit_n: float = Field(gt=0.0, description="largest thrust in either direction, N")
    time_constant_s: float = Field(gt=0.0, description="time constant of the first-order lag, s")
    slew_limit_n_s: float = Field(gt=0.0, description="largest rate of change of the thrust, N/s")
