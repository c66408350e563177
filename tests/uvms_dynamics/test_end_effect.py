"""Cross-flow drag of short cylinders against the table of the source; `test_strips`: the kernel."""

import numpy as np
import pytest

from uvms_core.vehicle.arm import DragCylinder
from uvms_core.vehicle.shapes import end_effect

DNV = {2: 0.58, 5: 0.62, 10: 0.68, 20: 0.74, 40: 0.82, 50: 0.87, 100: 0.98}
"""DNV-RP-C205 (2010), table 6-2: circular cylinder below the drag crisis."""


def cylinder(slenderness, **fields):
    axis, radius = (1.0, 0.0, 0.0), 0.05
    length = 2.0 * radius * slenderness
    return DragCylinder(
        center_m=(0.0, 0.0, 0.0), axis=axis, radius_m=radius, length_m=length, **fields
    )


@pytest.mark.parametrize(("slenderness", "kappa"), DNV.items())
def test_free_at_both_ends_it_is_the_table(slenderness, kappa):
    assert end_effect(cylinder(slenderness, free_ends=2)) == pytest.approx(kappa)


@pytest.mark.parametrize(("slenderness", "kappa"), DNV.items())
def test_with_one_free_end_the_length_counts_twice(slenderness, kappa):
    assert end_effect(cylinder(0.5 * slenderness)) == pytest.approx(kappa)


def test_without_free_ends_it_is_endless_and_long_ones_come_near_it():
    assert end_effect(cylinder(1.0, free_ends=0)) == 1.0
    assert end_effect(cylinder(1000.0, free_ends=2)) == 1.0
    values = [end_effect(cylinder(x, free_ends=2)) for x in np.geomspace(0.1, 300.0, 100)]
    assert (np.diff(values) >= 0.0).all()
    assert min(values) == 0.53


def test_a_given_factor_stands():
    assert end_effect(cylinder(3.0, end_effect=0.9)) == 0.9
