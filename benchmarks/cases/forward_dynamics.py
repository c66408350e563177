"""Forward dynamics of the reference vehicle: against Pinocchio's aba and the numpy reference."""

from collections.abc import Iterator

import numpy as np
from compiled import forward_loop
from metrics import Metric, Target
from motions import COUNT, dry_vehicle, motions
from paired import paired
from rigid import ABA, Aba

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, forward_dynamics
from uvms_dynamics.numpy_reference import newton_euler

KERNEL = "; ours called from compiled code, as the integrator does"
NUMPY = "the numpy reference, newton_euler.py"


def measure(full: bool) -> Iterator[Metric]:
    """Rigid bodies alone, then with the water, which Pinocchio does not model."""
    dry, wet = dry_vehicle(), load_vehicle()
    cases = motions(wet.n_joints)
    aba = Aba(dry, cases)
    for name, vehicle, bound in (("rigid", dry, 1.0), ("with_water", wet, 1.25)):
        loop, found = forward_loop(build_model(vehicle), cases)
        timing = paired(loop, {ABA: aba})
        if vehicle is dry:
            np.testing.assert_allclose(found, aba.results(), rtol=1e-8, atol=1e-8)
        yield Metric(
            f"forward_dynamics_{name}", 1e6 * timing.seconds / COUNT, "us", ABA + KERNEL,
            timing.ratio[ABA], Target("ratio", "<=", bound),
        )  # fmt: skip
    yield _against_numpy(wet, cases[:2])


def _against_numpy(vehicle, cases) -> Metric:
    model = build_model(vehicle)

    def kernel() -> None:
        for m in cases:
            forward_dynamics(model, m.quat, m.nu, m.q, m.q_dot, m.tau)

    def numpy_reference() -> None:
        for m in cases:
            newton_euler.forward_dynamics(vehicle, m.quat, m.nu, m.q, m.q_dot, m.tau)

    timing = paired(kernel, {NUMPY: numpy_reference}, rounds=5)
    return Metric(
        "forward_dynamics_against_numpy", 1e6 * timing.seconds / len(cases), "us", NUMPY,
        timing.ratio[NUMPY], Target("ratio", "<=", 0.01),
    )  # fmt: skip
