"""Forward dynamics with hydrodynamics, arms of 4 to 32 joints: against Pinocchio's rigid aba."""

from collections.abc import Callable, Iterator

import numpy as np
from chains import JOINTS, chain, without_water
from compiled import forward_loop
from metrics import Metric, Target
from motions import COUNT, Motion, motions
from paired import paired
from rigid import ABA, Aba

from uvms_dynamics import Model, build_model, forward_dynamics

GROWTH = (32, 8)


def measure(full: bool) -> Iterator[Metric]:
    """Ours called from Python, then in a compiled loop; last, how the loop grows with the arm."""
    loops = {}
    for n in JOINTS:
        vehicle, cases = chain(n), motions(n)
        aba, model = Aba(vehicle, cases), build_model(vehicle)
        _check_same_bodies(vehicle, cases, aba)
        loops[n] = forward_loop(model, cases)[0]
        for how, ours, bound in (
            ("python", _from_python(model, cases), 0.9),
            ("compiled", loops[n], 0.3),
        ):
            timing = paired(ours, {ABA: aba})
            yield Metric(
                f"forward_dynamics_{how}_n{n}", 1e6 * timing.seconds / COUNT, "us",
                f"{ABA}, the same {n} joints", timing.ratio[ABA], Target("ratio", "<=", bound),
            )  # fmt: skip
    yield _growth(loops)


def _from_python(model: Model, cases: list[Motion]) -> Callable[[], None]:
    def work() -> None:
        for quat, nu, _, q, q_dot, _, tau in cases:
            forward_dynamics(model, quat, nu, q, q_dot, tau)

    return work


def _growth(loops: dict[int, Callable[[], None]]) -> Metric:
    long, short = GROWTH
    reference = f"the same with {short} joints"
    timing = paired(loops[long], {reference: loops[short]})
    return Metric(
        "forward_dynamics_growth", 1e6 * timing.seconds / COUNT, "us", reference,
        timing.ratio[reference], Target("ratio", "<=", 4.0),
    )  # fmt: skip


def _check_same_bodies(vehicle, cases: list[Motion], aba: Aba) -> None:
    """Without water both must agree, or the comparison is meaningless."""
    loop, found = forward_loop(build_model(without_water(vehicle)), cases)
    loop()
    expected = aba.results()
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())
