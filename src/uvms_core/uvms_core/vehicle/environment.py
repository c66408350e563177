"""Water, gravity, and the place of the world frame on the Earth."""

from pydantic import Field

from uvms_core.vehicle.parts import Part, Vector3


class Environment(Part):
    """The sea around the vehicle."""

    water_density_kg_m3: float = Field(gt=0.0, description="density of the water, kg/m^3")
    kinematic_viscosity_m2_s: float = Field(
        gt=0.0,
        description="kinematic viscosity of the water, m^2/s; sets the arm's Reynolds numbers",
    )
    gravity_m_s2: float = Field(gt=0.0, description="acceleration of gravity, m/s^2")
    atmospheric_pressure_pa: float = Field(ge=0.0, description="air pressure at the surface, Pa")
    seabed_depth_m: float | None = Field(
        default=None,
        gt=0.0,
        description="depth of a flat seabed, m, which the DVL needs for its altitude; none: it is"
        " always within the DVL's range",
    )
    datum_latitude_deg: float = Field(
        ge=-89.0, le=89.0, description="latitude of the origin of map_ned, degrees"
    )
    datum_longitude_deg: float = Field(
        ge=-180.0, le=180.0, description="longitude of the origin of map_ned, degrees"
    )
    magnetic_field_ut: Vector3 | None = Field(
        default=None,
        description="the Earth's magnetic field at the site: north, east, down, microtesla, as the"
        " World Magnetic Model gives it; a magnetometer needs it",
    )
