"""Geographic coordinates and the local tangent frame."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_core.geodesy import geodetic_to_ned, ned_to_geodetic

untimed = settings(deadline=None)  # the first call compiles
PLACES = st.tuples(*[st.floats(-5000.0, 5000.0)] * 3).map(np.array)


@untimed
@given(PLACES, st.floats(-89.0, 89.0), st.floats(-180.0, 180.0))
def test_there_and_back(place, latitude, longitude):
    there = ned_to_geodetic(place, latitude, longitude)
    np.testing.assert_allclose(geodetic_to_ned(*there, latitude, longitude), place, atol=1e-6)


def test_the_datum_is_the_origin():
    assert ned_to_geodetic(np.zeros(3), 45.0, 126.0) == pytest.approx((45.0, 126.0, 0.0), abs=1e-8)


def test_a_minute_of_latitude_at_the_equator_and_near_the_pole():
    """WGS 84: the meridian's radius of curvature is 6335.439 km and 6399.594 km."""
    minute = np.radians(1.0 / 60.0)
    north = geodetic_to_ned(0.5 / 60.0, 0.0, 0.0, -0.5 / 60.0, 0.0)[0]
    assert north == pytest.approx(6335439.0 * minute, rel=1e-6)
    north = geodetic_to_ned(89.0, 0.0, 0.0, 89.0 - 1.0 / 60.0, 0.0)[0]
    assert north == pytest.approx(6399594.0 * minute, rel=1e-4)


def test_east_is_east_and_down_is_down():
    assert geodetic_to_ned(10.0, 20.001, 0.0, 10.0, 20.0)[1] > 100.0
    np.testing.assert_allclose(
        geodetic_to_ned(10.0, 20.0, -7.0, 10.0, 20.0), (0, 0, 7.0), atol=1e-8
    )
