"""Navigation filter and disturbance observer of the vehicle-manipulator system."""

from uvms_observer.disturbance import (
    CombinedObserver,
    DisturbanceObserver,
    ModelObserver,
    ObserverConfig,
    external_bandwidth,
)
from uvms_observer.errors import NotAlignedError, ObserverError
from uvms_observer.interfaces import NavigationEstimator, ObserverLaw
from uvms_observer.navigation import NavigationConfig, NavigationFilter

__all__ = [
    "CombinedObserver",
    "DisturbanceObserver",
    "ModelObserver",
    "NavigationConfig",
    "NavigationEstimator",
    "NavigationFilter",
    "NotAlignedError",
    "ObserverConfig",
    "ObserverError",
    "ObserverLaw",
    "external_bandwidth",
]
