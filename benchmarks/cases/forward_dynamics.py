"""Forward dynamics: the kernel against Pinocchio's aba and against the numpy twin."""

from collections.abc import Iterator

import numpy as np
import pinocchio as pin
from figures import Figure, Target
from motions import COUNT, dry_vehicle, motions
from numba import njit
from paired import paired
from rigid import pinocchio_model

from uvms_dynamics import build_model, forward_dynamics, load_vehicle, newton_euler

ABA = "pinocchio.aba called from Python, rigid bodies alone"
KERNEL = "; ours called from compiled code, as the integrator does"


@njit(cache=True)
def _all(model, quat, nu, q, q_dot, tau, out):
    """Every motion once."""
    for i in range(quat.shape[0]):
        out[i] = forward_dynamics(model, quat[i], nu[i], q[i], q_dot[i], tau[i])


def measure(full: bool) -> Iterator[Figure]:
    """Rigid bodies alone, then with the water, which Pinocchio does not know."""
    dry, wet = dry_vehicle(), load_vehicle()
    cases = motions(wet.n_joints)
    model, rigid = build_model(dry), pinocchio_model(dry)
    data = rigid.createData()
    theirs = [
        (np.concatenate([np.zeros(3), m.quat, m.q]), np.concatenate([m.nu, m.q_dot]), m.tau)
        for m in cases
    ]
    for m, arguments in zip(cases, theirs, strict=True):
        found = forward_dynamics(model, m.quat, m.nu, m.q, m.q_dot, m.tau)
        np.testing.assert_allclose(found, pin.aba(rigid, data, *arguments), rtol=1e-8, atol=1e-8)

    def aba() -> None:
        for arguments in theirs:
            pin.aba(rigid, data, *arguments)

    for name, tables, bound in (
        ("rigid", model, 1.0),
        ("with_water", build_model(wet), 0.8),
    ):
        timing = paired(_compiled(tables, cases), {ABA: aba})
        yield Figure(
            f"forward_dynamics_{name}", 1e6 * timing.seconds / COUNT, "us", ABA + KERNEL,
            timing.speedup[ABA], Target("ratio", ">=", bound),
        )  # fmt: skip
    yield from _from_python(wet, cases, aba)


def _compiled(model, cases):
    columns = [
        np.array([getattr(m, k) for m in cases]) for k in ("quat", "nu", "q", "q_dot", "tau")
    ]
    out = np.empty_like(columns[-1])
    return lambda: _all(model, *columns, out)


def _from_python(vehicle, cases, aba) -> Iterator[Figure]:
    model = build_model(vehicle)

    def kernel(some=cases) -> None:
        for m in some:
            forward_dynamics(model, m.quat, m.nu, m.q, m.q_dot, m.tau)

    def twin() -> None:
        for m in few:
            newton_euler.forward_dynamics(vehicle, m.quat, m.nu, m.q, m.q_dot, m.tau)

    timing = paired(kernel, {ABA: aba})
    value = 1e6 * timing.seconds / COUNT
    yield Figure("forward_dynamics_from_python", value, "us", ABA, timing.speedup[ABA])
    numpy, few = "the numpy twin, newton_euler.py", cases[:2]
    timing = paired(lambda: kernel(few), {numpy: twin}, rounds=5)
    value = 1e6 * timing.seconds / len(few)
    yield Figure(
        "forward_dynamics_against_numpy", value, "us", numpy, timing.speedup[numpy],
        Target("ratio", ">=", 100.0),
    )  # fmt: skip
