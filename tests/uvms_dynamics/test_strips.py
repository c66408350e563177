"""How many strips the drag of a link needs: convergence to a fine sum over the whole length.

One link lies along x from its joint at the origin, which turns about z; the hull moves along y. So
a place s of the link moves across its axis with v + q_dot s.
"""

import independent_dynamics as independent
import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import build_model, inverse_dynamics

LENGTH, STATIONS = 0.5, np.array([1, 2, 3, 4, 6, 8, 12, 16, 24, 32])
PIECES = 4000
CONSTANT = {"reynolds": [1.0, 1e6], "cd": [1.1, 1.1]}
MOTIONS = {  # speed of the joint's end, m/s, and rate, rad/s
    "across the flow": (0.3, 0.0),
    "turning about its end": (0.0, 0.5),
    "turning about its middle": (-0.125, 0.5),
    "turning about a point near its end": (-0.02, 0.5),
}


def vehicle_of(stations, coefficient=None, free_ends=0):
    """One straight link, endless or not; no strips at all for stations = 0."""
    data = REFERENCE.model_dump(mode="json")
    arm = data["arm"]
    arm.update(base={"position_m": [0.0, 0.0, 0.0]}, stowed_deg=[0.0], postures_deg={})
    joint = {"a_m": 0.0, "alpha_deg": 0.0, "d_m": 0.0, "offset_deg": 0.0}
    arm["joints"] = [arm["joints"][0] | joint]
    cylinder = {"center_m": [0.5 * LENGTH, 0.0, 0.0], "axis": [1.0, 0.0, 0.0]}
    cylinder |= {"radius_m": 0.04, "length_m": LENGTH, "free_ends": free_ends}
    drag = [cylinder | {"stations": stations}] if stations else []
    arm["links"] = [arm["links"][0] | {"drag": drag, "cylinder": None}]
    if coefficient:
        arm["drag_coefficient"] = coefficient
    return vehicle_from_data(data)


def moment(stations, motion, coefficient=None, free_ends=0):
    """Torque of the drag on the joint, N m, by the kernel."""
    nu, rate = np.array([0.0, motion[0], 0.0, 0.0, 0.0, 0.0]), np.array([motion[1]])
    quat, zero = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(1)
    torques = [
        inverse_dynamics(build_model(vehicle), quat, nu, np.zeros(6), zero, rate, zero)[6]
        for vehicle in (
            vehicle_of(0, coefficient),
            vehicle_of(stations, coefficient, free_ends),
        )
    ]
    return torques[0] - torques[1]


def fine_moment(motion, coefficient=None):
    """The same by the midpoint rule over many short pieces."""
    vehicle = vehicle_of(1, coefficient)
    cylinder, width, total = vehicle.arm.links[0].drag[0], LENGTH / PIECES, 0.0
    for s in (np.arange(PIECES) + 0.5) * width:
        velocity = np.array([0.0, motion[0] + motion[1] * s, 0.0])
        total += s * independent.line_drag(vehicle, cylinder, velocity)[1] * width
    return total


def errors(motion, coefficient=None):
    """Relative error of the moment for each number of stations."""
    exact = fine_moment(motion, coefficient)
    return np.array([abs(moment(int(n), motion, coefficient) / exact - 1.0) for n in STATIONS])


@pytest.mark.parametrize("stations", [2, 3, 7, 50])
def test_two_strips_are_exact_where_the_drag_is_a_polynomial(stations):
    """Constant C_D, turning about the joint: the torque is 1/2 rho C_D D rate^2 L^4 / 4."""
    rate, water = 0.5, REFERENCE.environment.water_density_kg_m3
    exact = -0.5 * water * 1.1 * 0.08 * rate**2 * LENGTH**4 / 4.0
    assert moment(stations, (0.0, rate), CONSTANT) == pytest.approx(exact, rel=1e-12)
    assert fine_moment((0.0, rate), CONSTANT) == pytest.approx(exact, rel=1e-7)
    assert abs(moment(1, (0.0, rate), CONSTANT) / exact - 1.0) > 0.4  # one strip is not enough


def test_where_the_flow_changes_sign_the_error_falls_at_fourth_order():
    """|v| v has a kink there, so a Gauss rule is no better; the worst place is the middle."""
    found = errors(MOTIONS["turning about its middle"], CONSTANT)
    many = STATIONS >= 4
    slope = np.polyfit(np.log(STATIONS[many]), np.log(found[many]), 1)[0]
    assert slope == pytest.approx(-4.0, abs=0.3)
    assert (found <= 5.0 / STATIONS**4.0).all()


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
def test_with_the_files_coefficient_it_converges_too(motion):
    """Down to what the fine sum itself makes of the corners of the C_D table."""
    found = errors(motion)
    assert (found <= 6.0 / STATIONS**4.0 + 1e-5).all()
    assert found[STATIONS == 4][0] < 0.01


def test_a_link_that_hangs_on_another_has_one_free_end():
    """0.5 m and 8 cm thick, 2 L / D = 12.5: 0.68 at 10 and 0.74 at 20 of DNV-RP-C205's table."""
    factor = 0.68 + 0.06 * np.log(1.25) / np.log(2.0)
    motion = (0.3, 0.5)
    ratio = moment(3, motion, CONSTANT, free_ends=1) / moment(3, motion, CONSTANT)
    assert ratio == pytest.approx(factor, rel=1e-9)
