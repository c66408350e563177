"""Many independent simulations at once: Runge-Kutta steps per second, against one by one."""

from collections.abc import Iterator

from chains import chain
from compiled import BATCH_STEPS, STEPS, stepping, stepping_batch
from metrics import Metric, Target
from motions import slow_motion
from paired import paired

BATCH = 1024
REFERENCE = "our own compiled loop over one simulation, the same {n} joints"


def measure(full: bool) -> Iterator[Metric]:
    """One thread; every simulation has a state and commands of its own."""
    for n in (4, 8):
        vehicle = chain(n)
        batch = stepping_batch(vehicle, [slow_motion(n, seed) for seed in range(BATCH)])
        timing = paired(batch, {"single": stepping(vehicle, slow_motion(n))})
        steps = BATCH * BATCH_STEPS
        yield Metric(
            f"rk4_steps_batch_n{n}", steps / timing.seconds, "1/s", REFERENCE.format(n=n),
            steps / STEPS / timing.ratio["single"], Target("ratio", ">=", 2.0),
        )  # fmt: skip
