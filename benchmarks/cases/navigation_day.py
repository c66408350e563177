"""A day of the navigation filter at the inertial unit's full rate: covariance and memory."""

import resource
from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from navigation_runs import Motion, Rig, Waves

from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter

BLOCK_S = 60.0


def measure(full: bool) -> Iterator[Metric]:
    """24 h with --full, else a quarter of an hour; a block of samples over and over, at new stamps.

    The vehicle goes to and fro on a motion that repeats after a block, so that its samples fit.
    """
    blocks = round((86_400.0 if full else 900.0) / BLOCK_S)
    vehicle = load_vehicle()
    navigation = NavigationFilter(vehicle, NavigationConfig(initial_position_m=(0.0, 0.0, 10.0)))
    frames = list(Rig(vehicle, _repeating()).frames(BLOCK_S))[1:]
    least, early = np.inf, 0
    for block in range(blocks):
        shift = to_nanoseconds(BLOCK_S) * block
        for stamp, *groups in frames:
            navigation.step(stamp + shift, *([_later(s, shift) for s in g] for g in groups))
        P = navigation.state.covariance
        sigma = np.sqrt(P.diagonal())
        least = min(least, float(np.linalg.eigvalsh(P / np.outer(sigma, sigma)).min()))
        early = early or (_peak() if block >= min(10, blocks // 2) else 0)
    yield Metric(
        "navigation_day_covariance", least, "", f"least eigenvalue of the correlations, {blocks}"
        " minutes", None, Target("value", ">=", -1e-9),
    )  # fmt: skip
    yield Metric(
        "navigation_day_memory", (_peak() - early) / 1024.0, "MB", "growth of the peak after the"
        " first minutes", None, Target("value", "<=", 5.0),
    )  # fmt: skip
    gated = navigation.status()["dvl_gated"]
    yield Metric("navigation_day_gated", float(gated), "DVL samples", None, None, None)


def _repeating():

    return Motion(
        Waves((0, 0, 10), amplitude=(3.0, 2.0, 0.5), period_s=(60.0, 30.0, 20.0)),
        Waves((0.02, -0.03, 0.2), amplitude=(0.03, 0.02, 0.4), period_s=(10.0, 12.0, 60.0)),
    )


def _later(sample, shift: int):
    values = {**vars(sample), "stamp": sample.stamp + shift}
    values.pop("_checked", None)
    return type(sample)(**values)


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
