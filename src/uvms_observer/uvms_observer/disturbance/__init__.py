"""The disturbance observer, eq. (21)."""

from uvms_observer.disturbance.config import ObserverConfig
from uvms_observer.disturbance.observer import DisturbanceObserver

__all__ = ["DisturbanceObserver", "ObserverConfig"]
