"""Inverse dynamics: the kernel against the numpy reference and Pinocchio's rnea."""

from collections.abc import Iterator

import numpy as np
import pinocchio as pin
from metrics import Metric, Target
from motions import COUNT, dry_vehicle, motions
from paired import paired
from rigid import pinocchio_model

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, inverse_dynamics
from uvms_dynamics.numpy_reference import newton_euler

NUMPY = "the numpy reference, newton_euler.py"
RNEA = "pinocchio.rnea from Python, rigid bodies alone (ours with the water)"


def measure(full: bool) -> Iterator[Metric]:
    """All called from Python, as the controller does."""
    vehicle = load_vehicle()
    model, rigid = build_model(vehicle), pinocchio_model(dry_vehicle())
    data = rigid.createData()
    arguments = [m[:-1] for m in motions(vehicle.n_joints)]
    theirs = [
        (
            np.concatenate([np.zeros(3), quat, q]),
            np.concatenate([nu, q_dot]),
            np.concatenate([nu_dot, q_ddot]),
        )
        for quat, nu, nu_dot, q, q_dot, q_ddot in arguments
    ]
    for motion in arguments:
        expected = newton_euler.inverse_dynamics(vehicle, *motion)
        np.testing.assert_allclose(inverse_dynamics(model, *motion), expected, rtol=1e-6, atol=1e-6)
    timing = paired(
        lambda: [inverse_dynamics(model, *motion) for motion in arguments],
        {
            NUMPY: lambda: [newton_euler.inverse_dynamics(vehicle, *m) for m in arguments],
            RNEA: lambda: [pin.rnea(rigid, data, *m) for m in theirs],
        },
        rounds=11,
    )
    for name, reference, target in (
        ("inverse_dynamics", NUMPY, Target("ratio", "<=", 0.033)),
        ("inverse_dynamics_from_python", RNEA, None),
    ):
        value = 1e6 * timing.seconds / COUNT
        yield Metric(name, value, "us", reference, timing.ratio[reference], target)
