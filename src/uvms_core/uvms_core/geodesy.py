"""Between geographic coordinates and the local tangent frame map_ned, on the WGS 84 ellipsoid."""

import math

import numpy as np

from uvms_core.signals import Array

_A = 6378137.0  # equatorial radius, m (NIMA TR8350.2)
_F = 1.0 / 298.257223563  # flattening
_E2 = _F * (2.0 - _F)  # first eccentricity squared
_ITERATIONS = 5  # of the latitude; each gains a factor of 300


def geodetic_to_ned(
    latitude_deg: float,
    longitude_deg: float,
    altitude: float,
    datum_latitude_deg: float,
    datum_longitude_deg: float,
) -> Array:
    """Position (3,) in map_ned, m: north, east, down from the datum at altitude zero.

    Exact, through earth-centered coordinates (Farrell 2008, Aided Navigation, sec. 2.3).
    """
    origin = _to_earth(datum_latitude_deg, datum_longitude_deg, 0.0)
    place = _to_earth(latitude_deg, longitude_deg, altitude)
    return _earth_to_ned(datum_latitude_deg, datum_longitude_deg) @ (place - origin)


def ned_to_geodetic(
    position: Array, datum_latitude_deg: float, datum_longitude_deg: float
) -> tuple[float, float, float]:
    """Latitude and longitude in degrees and altitude in m of a position (3,) in map_ned."""
    origin = _to_earth(datum_latitude_deg, datum_longitude_deg, 0.0)
    place = origin + _earth_to_ned(datum_latitude_deg, datum_longitude_deg).T @ position
    return _from_earth(place)


def _to_earth(latitude_deg: float, longitude_deg: float, altitude: float) -> Array:
    """Earth-centred, earth-fixed coordinates (3,), m."""
    lat, lon = math.radians(latitude_deg), math.radians(longitude_deg)
    normal = _A / math.sqrt(1.0 - _E2 * math.sin(lat) ** 2)
    across = (normal + altitude) * math.cos(lat)
    up = (normal * (1.0 - _E2) + altitude) * math.sin(lat)
    return np.array([across * math.cos(lon), across * math.sin(lon), up])


def _from_earth(place: Array) -> tuple[float, float, float]:
    x, y, z = place
    across = math.hypot(x, y)
    latitude, height = math.atan2(z, across * (1.0 - _E2)), 0.0
    for _ in range(_ITERATIONS):
        normal = _A / math.sqrt(1.0 - _E2 * math.sin(latitude) ** 2)
        height = across * math.cos(latitude) + z * math.sin(latitude)
        height -= _A * math.sqrt(1.0 - _E2 * math.sin(latitude) ** 2)
        latitude = math.atan2(z, across * (1.0 - _E2 * normal / (normal + height)))
    return math.degrees(latitude), math.degrees(math.atan2(y, x)), height


def _earth_to_ned(latitude_deg: float, longitude_deg: float) -> Array:
    """Rotation (3, 3) from earth-centred axes to north, east, down."""
    lat, lon = math.radians(latitude_deg), math.radians(longitude_deg)
    s, c, sl, cl = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
    return np.array([[-s * cl, -s * sl, c], [-sl, cl, 0.0], [-c * cl, -c * sl, -s]])
