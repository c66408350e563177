"""Shapes of vehicles by rule, and which pairs of bodies count."""

import numpy as np
import pytest
from random_vehicles import random_vehicle

from uvms_core.vehicle import joint_limits, load_vehicle
from uvms_core.vehicle.locate import known_vehicles, vehicle_path
from uvms_core.vehicle.outline import hull_outlines, link_outlines
from uvms_dynamics.geometry import HULL_NAME, build_geometry, clearances_along

SHIPPED = sorted(known_vehicles())


@pytest.mark.parametrize("name", SHIPPED)
def test_neighbours_and_what_never_comes_apart_do_not_count(name):
    """Every pair that is left comes apart somewhere, and every posture of the file is possible."""
    vehicle = load_vehicle(vehicle_path(name))
    geometry = build_geometry(vehicle)
    bodies = [HULL_NAME, *(link.name for link in vehicle.arm.links)]
    gaps = {abs(bodies.index(pair.body) - bodies.index(pair.other)) for pair in geometry.pairs}
    assert min(gaps) >= 2
    angles = np.radians([vehicle.arm.stowed_deg, *vehicle.arm.postures_deg.values()])
    rows = np.column_stack([np.zeros((len(angles), 4)), angles])
    assert clearances_along(geometry, rows).min() > 0.0


def test_links_that_never_come_apart():
    """The BlueROV2's wrist hangs 2 cm from the end of an upper arm that is 4 cm thick."""
    geometry = build_geometry(load_vehicle(vehicle_path("bluerov2_alpha5")))
    assert ("wrist_link", "upper_arm") not in {(pair.body, pair.other) for pair in geometry.pairs}


def test_a_link_without_a_shape_has_the_capsule_of_its_volume():
    vehicle = load_vehicle(vehicle_path("bluerov2_alpha5"))
    for number in (0, 2):
        (capsule,) = link_outlines(vehicle.arm, number)
        length = np.linalg.norm(capsule.end - capsule.start)
        volume = np.pi * capsule.radius**2 * (length + 4.0 / 3.0 * capsule.radius)
        assert volume == pytest.approx(vehicle.arm.links[number].volume_m3, rel=1e-9)


def test_a_hull_without_a_shape_has_the_cuboid_of_its_inertia():
    hull = random_vehicle(4, 2).hull
    (box,) = hull_outlines(hull)
    squares = (2.0 * box.half) ** 2
    moments = hull.mass_kg / 12.0 * (squares.sum() - squares)
    inertia = box.rotation @ np.diag(moments) @ box.rotation.T
    assert inertia == pytest.approx(np.array(hull.inertia_kg_m2), rel=1e-9, abs=1e-9)
    assert np.linalg.det(box.rotation) == pytest.approx(1.0)


def test_a_copy_ten_times_as_heavy_has_all_its_clearances_times_the_cube_root():
    small, large = (
        build_geometry(load_vehicle(vehicle_path(name)))
        for name in ("reference_auv", "reference_auv_heavy")
    )
    rows = np.zeros((20, 8))
    rows[:, 4:] = np.random.default_rng(0).uniform(*joint_limits(load_vehicle()), (20, 4))
    expected = np.cbrt(10.0) * clearances_along(small, rows)
    assert clearances_along(large, rows) == pytest.approx(expected, rel=1e-9)
