"""The disturbance observer, eq. (21)."""

from uvms_observer.disturbance.observer import DisturbanceObserver
from uvms_observer.disturbance.observer_config import ObserverConfig

__all__ = ["DisturbanceObserver", "ObserverConfig"]
