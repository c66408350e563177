"""The table of `uvms validate` about navigation."""

from collections.abc import Sequence

import numpy as np

from uvms_analysis.trials.navigate import FIX_RATE_HZ, FIX_STD_M, Navigated

_HEAD = f"{'navigation':<18}{'median mm':>10}{'95 % mm':>9}{'largest mm':>12}{'stated mm':>11}{'in 3 sigma':>12}{'fixes':>7}{'refused':>9}"  # noqa: E501

LEGEND = f"""\
The navigation filter with the vehicle's own inertial unit and the motion capture's position at
{FIX_RATE_HZ:g} Hz as fixes (std {1e3 * FIX_STD_M:g} mm), against the motion capture at full rate.
median, 95 %, largest: of the error of the position over the samples with moc_ok = 1.
stated: median of the filter's own standard deviation of the position.
in 3 sigma: share of samples with the error along each axis within three of its deviations.
refused: fixes that the filter did not use."""


def navigation_text(found: Sequence[Navigated]) -> str:
    """A row for each trial, and all of them together."""
    lines = [_HEAD, *(_row(each.name, [each]) for each in found)]
    return "\n".join([*lines, "-" * len(_HEAD), _row(f"all {len(found)}", found), "", LEGEND])


def _row(label: str, trials: Sequence[Navigated]) -> str:
    distance = 1e3 * np.concatenate([each.distance for each in trials])
    stated = 1e3 * np.concatenate([np.linalg.norm(each.std, axis=1) for each in trials])
    median, most = np.percentile(distance, [50.0, 95.0])
    inside = np.average(
        [each.share_inside for each in trials], weights=[len(e.error) for e in trials]
    )
    return (
        f"{label:<18}{median:10.2f}{most:9.2f}{distance.max():12.1f}{np.median(stated):11.2f}"
        f"{_percent(inside):>12}{sum(e.fixes for e in trials):7d}{sum(e.gated for e in trials):9d}"
    )


def _percent(share: float) -> str:
    """Whole where it is whole; rounded down, so that 100 % means all."""
    return "100 %" if share == 1.0 else f"{np.floor(1e4 * share) / 1e2:.2f} %"
