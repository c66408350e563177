"""One thruster of the vehicle."""

from pydantic import Field

from uvms_core.vehicle.parts import Part, UnitVector, Vector3


class Thruster(Part):
    """A fixed thruster that pushes both ways, with first-order lag and slew limit."""

    name: str = Field(min_length=1, description="name in thruster_command")
    position_m: Vector3 = Field(description="where its force acts, body frame, m")
    direction: UnitVector = Field(description="of positive thrust on the vehicle, body frame")
    limit_n: float = Field(gt=0.0, description="greatest thrust, either way, N")
    time_constant_s: float = Field(gt=0.0, description="of the first-order lag, s")
    slew_limit_n_s: float = Field(gt=0.0, description="greatest rate of change of the thrust, N/s")
