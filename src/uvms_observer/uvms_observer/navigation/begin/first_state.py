"""The state with which an estimator begins, from the first sample of its inertial unit."""

from collections.abc import Mapping
from functools import partial

import numpy as np

from uvms_core.signals import ImuSample, Odometry
from uvms_observer.navigation.begin.alignment import aligned, levelled
from uvms_observer.navigation.begin.resume import lost
from uvms_observer.navigation.inertial.installation import Installation
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.samples import Reading
from uvms_observer.navigation.state import NavigationState


def first_state(
    sample: ImuSample,
    heading: Reading | None,
    measurements: Mapping[str, Measurement],
    imu: Installation,
    config: NavigationConfig,
    start: Odometry | None,
) -> tuple[NavigationState, ImuSample] | None:
    """State at the stamp of a sample; None where no attitude follows from it.

    Args:
        sample: of the inertial unit.
        heading: of another sensor, which a unit without attitude needs.
        measurements: by the name of their sensors.
        imu, config: of the vehicle and its filter.
        start: where to begin; None: as configured.

    Returns:
        The state, and the sample with the attitude that it has been given.
    """
    if not sample.oriented:
        if heading is None:
            return None
        found = partial(measurements[heading.name].heading, heading.sample)
        sample, imu = levelled(sample, imu, found)
    if start is None and config.start == "fixes":
        start = lost(sample.stamp, np.array(config.initial_position_m))
    state = aligned(sample, imu, config, start)
    for each in measurements.values():
        state = each.begin(state)
        for index, variance in each.initial_variance.items():
            state.covariance[index, index] = variance
    return state, sample
