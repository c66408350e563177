"""Navigation filter and disturbance observer of the vehicle-manipulator system."""

from uvms_observer.disturbance import DisturbanceObserver, ObserverConfig
from uvms_observer.errors import NotAlignedError, ObserverError
from uvms_observer.interfaces import NavigationEstimator, ObserverLaw
from uvms_observer.navigation import NavigationConfig, NavigationFilter

__all__ = [
    "DisturbanceObserver",
    "NavigationConfig",
    "NavigationEstimator",
    "NavigationFilter",
    "NotAlignedError",
    "ObserverConfig",
    "ObserverError",
    "ObserverLaw",
]
