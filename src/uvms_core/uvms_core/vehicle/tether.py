"""A tether whose pull on the vehicle changes with the depth."""

from typing import Annotated

from pydantic import Field

from uvms_core.vehicle.parts import Part

PerMetre = Annotated[float, Field(ge=-1000.0, le=1000.0)]


class Tether(Part):
    """Weight in water, and its first moment, that grow linearly with the depth.

    At depth d of the body origin the tether pulls with the weight w (d - d0) down, which has the
    first moment m (d - d0): with k down in body axes it acts as (w k, m x k) (d - d0). Farther than
    `linear_within_m` from d0 the pull stays as it is there: a slope that was measured over a metre
    of depth must not be extrapolated to ten. The plant, `uvms validate` and `uvms identify` include
    it. Planner, observer and controller do not know of it: to them it is a disturbance, `external`
    in the plant's true disturbance.
    """

    reference_depth_m: float = Field(description="depth d0 at which the tether does not pull, m")
    linear_within_m: float = Field(
        default=1e4, gt=0.0, description="distance from d0 beyond which the pull is constant, m"
    )
    weight_per_m_n: PerMetre = Field(
        default=0.0, description="w, weight in water for each metre below d0, N/m; < 0 pulls up"
    )
    moment_per_m_nm: tuple[PerMetre, PerMetre, PerMetre] = Field(
        default=(0.0, 0.0, 0.0),
        description="m, first moment (position times weight) for each metre below d0, body frame,"
        " N m/m",
    )
