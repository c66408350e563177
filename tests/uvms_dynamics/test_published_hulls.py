"""Published hulls as they are printed: they can be entered, and behave as published."""

import numpy as np
import pytest
from published_hulls import ECA_A9, LAUV, REMUS_100, hull_vehicle, sway_yaw

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle.damping import added_mass_products, lift_matrix
from uvms_dynamics import build_model, hull_bias_wrench, mass_matrix


def slopes(vehicle, speed):
    """A (2, 2) of (v, r) by differences of the kernels, at a surge speed."""
    model, n, h = build_model(vehicle), vehicle.n_joints, 1e-6
    inertia = mass_matrix(model, np.zeros(n))[:6, :6]
    columns = []
    for axis in (1, 5):
        step = h * np.eye(6)[axis]
        ahead = speed * np.eye(6)[0]
        bias = hull_bias_wrench(model, ahead + step) - hull_bias_wrench(model, ahead - step)
        columns.append(-bias / (2.0 * h))
    pair = np.ix_([1, 5], [1, 5])
    return np.linalg.solve(inertia[pair], np.array(columns).T[[1, 5]])


def test_remus_grows_as_published():
    """Prestero's table: 0.995 1/s at 1.5 m/s, unstable without its pilot; twice that without lift.

    By hand from the printed coefficients, which contain the added mass's part:
    (m - Y_vdot) v' - Y_rdot r' = Y_uv u v + (Y_ur - m) u r,
    -N_vdot v' + (I_z - N_rdot) r' = N_uv u v + N_ur u r.
    """
    m, u = 299.0 / 9.81, 1.5
    inertia = np.array([[m + 35.5, -1.93], [-1.93, 3.45 + 4.88]])
    printed = np.linalg.solve(inertia, u * np.array([[-28.6, 5.22 - m], [-24.0, -2.0]]))
    assert np.linalg.eigvals(printed).max() == pytest.approx(0.995, abs=5e-4)
    vehicle = hull_vehicle(REMUS_100)
    np.testing.assert_allclose(slopes(vehicle, u), printed, rtol=1e-5)
    np.testing.assert_allclose(sway_yaw(vehicle.hull, u), printed, rtol=1e-6)
    without = hull_vehicle(REMUS_100 | {"cross_terms": None})
    assert np.linalg.eigvals(slopes(without, u)).max() == pytest.approx(2.115, abs=1e-3)


def test_what_the_added_mass_gives_is_taken_off_the_printed_coefficients():
    """Munk's moment is N_uv = -(X_udot - Y_vdot) = -34.57; lift and fins leave +10.57."""
    vehicle = hull_vehicle(REMUS_100)
    inertial = added_mass_products(np.array(vehicle.hull.added_mass))
    munk = {(5, 1): -34.57, (4, 2): 34.57, (1, 5): -0.93, (2, 4): 0.93, (5, 5): 1.93, (1, 1): 0.0}
    for place, value in munk.items():
        assert inertial[place] == pytest.approx(value, abs=1e-9)
    lift = -lift_matrix(vehicle.hull)
    expected = {(1, 1): -28.6, (1, 5): 6.15, (5, 1): 10.57, (5, 5): -3.93, (4, 2): -10.57}
    for place, value in expected.items():
        assert lift[place] == pytest.approx(value, abs=1e-9)


def test_the_vertical_twin_is_the_mirror_image():
    """M_uw = -N_uv and Z_uq = -Y_ur: z is to q what -y is to r."""
    lift = lift_matrix(hull_vehicle(REMUS_100).hull)
    np.testing.assert_allclose(lift[np.ix_([2, 4], [2, 4])], lift[np.ix_([1, 5], [1, 5])]
                               * [[1, -1], [-1, 1]], atol=1e-9)  # fmt: skip


@pytest.mark.parametrize("hull", [LAUV, ECA_A9], ids=["LAUV", "ECA A9"])
def test_printed_tables_are_taken_as_they_are(hull):
    vehicle = hull_vehicle(hull)
    np.testing.assert_allclose(slopes(vehicle, 1.0), sway_yaw(vehicle.hull, 1.0), rtol=1e-5)


def test_lauv_has_its_side_force_of_yaw_rate():
    """Y_r = +11.5 and N_v = -3.1 of the print, with the quadratic Y_r|r| = 0.3, N_v|v| = -1.5."""
    model = build_model(hull_vehicle(LAUV))
    turning = -hull_bias_wrench(model, np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.2]))
    assert turning[1] == pytest.approx(11.5 * 0.2 + 0.3 * 0.2**2)
    drifting = -hull_bias_wrench(model, np.array([0.0, -0.3, 0.0, 0.0, 0.0, 0.0]))
    assert drifting[5] == pytest.approx(3.1 * 0.3 + 1.5 * 0.3**2)


def test_what_feeds_energy_is_refused_with_entry_speed_and_value():
    """N_uv without Munk's moment in it would be a source of energy."""
    terms = REMUS_100["cross_terms"] | {"added_mass_included": False}
    with pytest.raises(VehicleFileError) as fault:
        hull_vehicle(REMUS_100 | {"cross_terms": terms})
    assert "hull.cross_terms.N_uv: is -24: at 3 m/s of surge the damping feeds 2.94 W" in str(
        fault.value
    )
    slow = REMUS_100 | {"speeds_m_s": [0.0, 0.0], "cross_terms": terms}
    hull_vehicle(slow)  # at rest, where it does nothing


def test_linear_and_quadratic_entries_that_feed_energy_are_named():
    linear = [list(row) for row in LAUV["linear_damping"]]
    linear[1][5] = -40.0
    with pytest.raises(VehicleFileError, match=r"hull\.linear_damping\.1\.5: row 2, column 6 is"):
        hull_vehicle(LAUV | {"linear_damping": linear})
    quadratic = [list(row) for row in LAUV["quadratic_damping"]]
    quadratic[1][5] = 300.0
    with pytest.raises(VehicleFileError, match=r"hull\.quadratic_damping\.1\.5: row 2, column 6"):
        hull_vehicle(LAUV | {"quadratic_damping": quadratic})


def test_going_astern_lift_still_takes_energy():
    vehicle, rng = hull_vehicle(REMUS_100), np.random.default_rng(1)
    smooth = build_model(hull_vehicle(REMUS_100 | {
        "cross_terms": None, "linear_damping": [0.0] * 6, "quadratic_damping": [0.0] * 6,
    }))  # fmt: skip
    model = build_model(vehicle)
    for _ in range(500):
        nu = rng.normal(size=6)
        nu[0] = -abs(nu[0])
        taken = hull_bias_wrench(model, nu) - hull_bias_wrench(smooth, nu)
        assert nu @ taken >= 0.0


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ([1.0, 2.0, 3.0], "needs 6 diagonal values or 6 rows, has 3"),
        ([[1.0] * 6] * 5, "needs 6 rows of 6 values, has 5 rows of [6]"),
        ([[1.0] * 5] * 6, "needs 6 rows of 6 values, has 6 rows of [5]"),
        ([1.0, -1.0, 1.0, 1.0, 1.0, 1.0], "every value must be >= 0"),
    ],
)
def test_damping_of_another_shape_is_refused(value, text):
    with pytest.raises(VehicleFileError) as fault:
        hull_vehicle(LAUV | {"linear_damping": value})
    assert text in str(fault.value)


def test_six_values_and_their_diagonal_matrix_are_the_same_hull():
    diagonal = [2.4, 80.0, 80.0, 0.0006, 9.1, 9.1]
    hulls = [
        LAUV | {"linear_damping": [1.0] * 6, "quadratic_damping": damping}
        for damping in (diagonal, np.diag(diagonal).tolist())
    ]
    np.testing.assert_array_equal(*(build_model(hull_vehicle(hull)) for hull in hulls))
