"""Water, gravity, and where on the Earth the world frame lies."""

from pydantic import Field

from uvms_core.vehicle.parts import Part


class Environment(Part):
    """The sea around the vehicle."""

    water_density_kg_m3: float = Field(gt=0.0, description="density of the water, kg/m^3")
    kinematic_viscosity_m2_s: float = Field(
        gt=0.0, description="of the water, m^2/s; gives the Reynolds number of the arm's strips"
    )
    gravity_m_s2: float = Field(gt=0.0, description="acceleration of gravity, m/s^2")
    atmospheric_pressure_pa: float = Field(ge=0.0, description="pressure at the surface, Pa")
    datum_latitude_deg: float = Field(ge=-89.0, le=89.0, description="of map_ned's origin, degrees")
    datum_longitude_deg: float = Field(
        ge=-180.0, le=180.0, description="of map_ned's origin, degrees"
    )
