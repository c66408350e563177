"""What the water costs: forward dynamics in a compiled loop with all of it and without any."""

from collections.abc import Iterator

from chains import JOINTS, chain, without_water
from compiled import forward_loop
from metrics import Metric, Target
from motions import COUNT, motions
from paired import paired

from uvms_dynamics import build_model

DRY = "the same bodies without added mass, buoyancy, damping and strips"


def measure(full: bool) -> Iterator[Metric]:
    """Three strips of drag on every link, the vehicle file's default."""
    for n in JOINTS:
        wet, cases = chain(n), motions(n)
        loop, dry = (forward_loop(build_model(v), cases)[0] for v in (wet, without_water(wet)))
        timing = paired(loop, {DRY: dry})
        yield Metric(
            f"hydrodynamics_on_off_n{n}", 1e6 * timing.seconds / COUNT, "us", DRY,
            timing.ratio[DRY], Target("ratio", "<=", 1.4),
        )  # fmt: skip
