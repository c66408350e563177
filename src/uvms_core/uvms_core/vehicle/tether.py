"""A pull that changes with depth, as that of a tether does."""

from pydantic import Field

from uvms_core.vehicle.parts import Part, Vector3


class Tether(Part):
    """Linear change of wet weight and of its moment with depth, about a reference depth.

    At depth d the hull weighs w (d - d0) N more in the water, and that weight has the first moment
    m (d - d0): with k down in body axes it acts as (w k, m x k) (d - d0). `uvms validate` and
    `uvms identify` heed it; the plant has no tether.
    """

    reference_depth_m: float = Field(description="depth d0 at which it changes nothing, m")
    weight_per_m_n: float = Field(default=0.0, description="w, N per m of depth")
    moment_per_m_nm: Vector3 = Field(
        default=(0.0, 0.0, 0.0), description="m, body frame, N m per m of depth"
    )
