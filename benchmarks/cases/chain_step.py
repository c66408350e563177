"""One Runge-Kutta step of the whole plant, compiled: against one call of Pinocchio's rigid aba."""

from collections.abc import Iterator

from chains import JOINTS, chain
from compiled import STEPS, stepping
from figures import Figure, Target
from motions import COUNT, calm_motion, motions
from paired import paired
from rigid import ABA, Aba


def measure(full: bool) -> Iterator[Figure]:
    """A step is four times forward dynamics, with thrusters, friction, end stops and current."""
    for n in JOINTS:
        vehicle = chain(n)
        timing = paired(stepping(vehicle, calm_motion(n)), {ABA: Aba(vehicle, motions(n))})
        yield Figure(
            f"rk4_step_n{n}", 1e6 * timing.seconds / STEPS, "us", f"{ABA}, the same {n} joints",
            timing.ratio[ABA] * COUNT / STEPS, Target("ratio", "<=", 1.4),
        )  # fmt: skip
