"""Joints placed by an `origin` as in URDF: the same arm as by Denavit-Hartenberg fields."""

import numpy as np
import pytest
from random_vehicles import REFERENCE, random_motion, random_vehicle
from urdf_chains import as_urdf, real_vehicle

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import (
    build_model,
    end_effector,
    end_effector_jacobian,
    inverse_dynamics,
    mass_matrix,
    restoring_wrench,
)
from uvms_dynamics.numpy_reference import kinematics, newton_euler

CASES = [random_vehicle(31, 1), random_vehicle(32, 4), random_vehicle(33, 7)]
EXACT = {"rtol": 1e-12, "atol": 1e-10}


@pytest.fixture(params=CASES, ids=lambda vehicle: f"{vehicle.n_joints} joints")
def pair(request):
    """A chain in either form, and a motion of it."""
    vehicle = request.param
    motion = random_motion(np.random.default_rng(5), vehicle.n_joints)
    return vehicle, as_urdf(vehicle), motion


def test_the_same_dynamics(pair):
    dh, urdf, motion = pair
    one, other = build_model(dh), build_model(urdf)
    for function, arguments in (
        (inverse_dynamics, motion),
        (mass_matrix, (motion.q,)),
        (restoring_wrench, (motion.quat, motion.q)),
    ):
        expected = function(one, *arguments)
        limit = 1e-12 * np.abs(expected).max()
        np.testing.assert_allclose(function(other, *arguments), expected, rtol=1e-12, atol=limit)


def test_the_same_tool(pair):
    dh, urdf, motion = pair
    place = np.array([1.0, 2.0, 3.0]), motion.quat, motion.q
    for one, other in zip(
        end_effector(build_model(dh), *place),
        end_effector(build_model(urdf), *place),
        strict=True,
    ):
        np.testing.assert_allclose(other, one, atol=1e-12)
    np.testing.assert_allclose(
        end_effector_jacobian(build_model(urdf), motion.quat, motion.q),
        end_effector_jacobian(build_model(dh), motion.quat, motion.q),
        atol=1e-12,
    )


def test_the_numpy_reference_knows_both_forms(pair):
    """The numpy reference goes through placement, turn and distal pose one by one."""
    _, urdf, motion = pair
    model = build_model(urdf)
    np.testing.assert_allclose(
        inverse_dynamics(model, *motion), newton_euler.inverse_dynamics(urdf, *motion), **EXACT
    )
    np.testing.assert_allclose(
        end_effector_jacobian(model, motion.quat, motion.q),
        kinematics.end_effector_jacobian(urdf.arm, motion.quat, motion.q),
        **EXACT,
    )


def test_a_joint_that_is_placed_twice_or_not_at_all():
    data = REFERENCE.model_dump(mode="json")
    joint = data["arm"]["joints"][1]
    joint["origin"] = {"position_m": [0.1, 0.0, 0.0]}
    with pytest.raises(
        VehicleFileError, match=r"arm\.joints\.1: .* placed twice, by origin and by a_m, alpha_deg"
    ):
        vehicle_from_data(data)
    joint.update(origin=None, a_m=None)
    with pytest.raises(VehicleFileError, match=r"lacks a_m: a joint needs .* or an origin"):
        vehicle_from_data(data)


class TestAttachments:
    """Ballast, foam and the like become part of the hull."""

    EXTRAS = (
        {"name": "lead", "position_m": [0.3, -0.2, 0.1], "wet_weight_n": 4.0, "mass_kg": 0.45},
        {"name": "foam", "position_m": [-0.2, 0.1, -0.3], "wet_weight_n": -9.0},
    )

    def with_extras(self, extras):
        data = REFERENCE.model_dump(mode="json")
        data["hull"]["attachments"] = list(extras)
        return vehicle_from_data(data)

    def test_weight_and_moment(self):
        q = np.zeros(4)
        for quat in np.random.default_rng(2).normal(size=(3, 4)):
            quat = quat / np.linalg.norm(quat)
            added = restoring_wrench(build_model(self.with_extras(self.EXTRAS)), quat, q)
            added -= restoring_wrench(build_model(REFERENCE), quat, q)
            down = restoring_wrench(build_model(heavier(1.0)), quat, q)[:3]
            down = down - restoring_wrench(build_model(REFERENCE), quat, q)[:3]
            down /= np.linalg.norm(down)
            forces = [extra["wet_weight_n"] * down for extra in self.EXTRAS]
            places = [extra["position_m"] for extra in self.EXTRAS]
            moment = sum(np.cross(p, f) for p, f in zip(places, forces, strict=True))
            np.testing.assert_allclose(added, [*sum(forces), *moment], atol=1e-9)

    def test_inertia(self):
        """A point of 0.45 kg; the foam has no mass of its own."""
        q, place = np.zeros(4), np.array(self.EXTRAS[0]["position_m"])
        added = mass_matrix(build_model(self.with_extras(self.EXTRAS)), q)
        added -= mass_matrix(build_model(REFERENCE), q)
        x, y, z = place
        skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        jacobian = np.hstack([np.eye(3), -skew])
        np.testing.assert_allclose(added[:6, :6], 0.45 * jacobian.T @ jacobian, atol=1e-9)

    def test_trim_and_neutral_count_them(self):
        data = REFERENCE.model_dump(mode="json")
        data["hull"].update(attachments=list(self.EXTRAS), mass_kg="neutral")
        data["hull"]["cg_m"] = ["trim", "trim", 0.012]
        vehicle = vehicle_from_data(data)
        stowed = np.radians(vehicle.arm.stowed_deg)
        wrench = restoring_wrench(build_model(vehicle), np.array([0.0, 0.0, 0.0, 1.0]), stowed)
        np.testing.assert_allclose(wrench, 0.0, atol=1e-9)

    def test_names_differ(self):
        with pytest.raises(VehicleFileError, match=r"attachment names must differ; .*: lead"):
            self.with_extras((self.EXTRAS[0], self.EXTRAS[0]))


def heavier(kilograms):
    data = REFERENCE.model_dump(mode="json")
    data["hull"]["mass_kg"] += kilograms
    return vehicle_from_data(data)


def test_the_real_vehicle_has_the_weights_of_its_sources():
    """Static moment of hull and attachments with the source's own CB and volume, N m (FLU)."""
    vehicle = real_vehicle(
        **{
            "hull.cb_m": [0.0074, 0.0, -0.02],
            "hull.volume_m3": 0.0131214,
            "arm.base.rpy_deg": [180.0, 0.0, 0.0],
        }
    )
    hull, g = vehicle.hull, vehicle.environment.gravity_m_s2
    buoyancy = vehicle.environment.water_density_kg_m3 * hull.volume_m3 * g
    moment = buoyancy * np.array(hull.cb_m) - hull.mass_kg * g * np.array(hull.cg_m)
    arm_base = 1.3696 * np.array([0.175, 0.11565, -0.002])
    np.testing.assert_allclose(moment + arm_base, [2.200, 0.653, -3.828], atol=2e-3)
