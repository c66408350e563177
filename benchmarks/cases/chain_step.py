"""One Runge-Kutta step of the whole plant, compiled: against one call of Pinocchio's rigid aba."""

from collections.abc import Iterator

from chains import JOINTS, chain
from compiled import STEPS, stepping
from metrics import Metric, Target
from motions import COUNT, motions, slow_motion
from paired import paired
from rigid import ABA, Aba


def measure(full: bool) -> Iterator[Metric]:
    """A step is four times forward dynamics, with thrusters, friction, end stops and current."""
    for n in JOINTS:
        vehicle = chain(n)
        timing = paired(stepping(vehicle, slow_motion(n)), {ABA: Aba(vehicle, motions(n))})
        yield Metric(
            f"rk4_step_n{n}", 1e6 * timing.seconds / STEPS, "us", f"{ABA}, the same {n} joints",
            timing.ratio[ABA] * COUNT / STEPS, Target("ratio", "<=", 1.4),
        )  # fmt: skip
