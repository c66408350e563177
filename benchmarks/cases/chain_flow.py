"""What moving water costs: a Runge-Kutta step of the whole plant in each kind of flow."""

from collections.abc import Iterator

from chains import JOINTS, chain
from compiled import CURRENT, stepping
from metrics import Metric, Target
from motions import slow_motion
from paired import paired

CONSTANT = "the same step in a constant current"
_TURNING = {"speed_m_s": 0.2, "period_s": 60.0}
_GUST = {"at_s": 0.0, "duration_s": 2.0, "velocity_ned_m_s": (0.0, 0.5, 0.0)}
_SWING = {"amplitude_m_s": 0.2, "period_s": 8.0}
_WAVE = {"height_m": 1.0, "period_s": 8.0, "water_depth_m": 50.0}
FLOWS = {
    "stream": CURRENT.model_validate(
        {"turning": _TURNING, "gusts": [_GUST], "oscillating": [_SWING]}
    ),
    "waves": CURRENT.model_validate({"waves": [_WAVE]}),
}


def measure(full: bool) -> Iterator[Metric]:
    """A turning current, a gust and an oscillating one together; and one wave at every body."""
    for n in JOINTS[:1]:
        vehicle, motion = chain(n), slow_motion(n)
        constant = stepping(vehicle, motion)
        for name, flow in FLOWS.items():
            timing = paired(stepping(vehicle, motion, current=flow), {CONSTANT: constant})
            yield Metric(
                f"step_in_{name}_n{n}", timing.ratio[CONSTANT], "constant currents", CONSTANT,
                timing.ratio[CONSTANT], Target("ratio", "<=", 1.15 if name == "stream" else 2.0),
            )  # fmt: skip
