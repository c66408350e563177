"""Disturbance observers, from none to eq. (21) with external wrench and payload."""

from uvms_dynamics.external_bandwidth import external_bandwidth
from uvms_observer.disturbance.observer import (
    CombinedObserver,
    DisturbanceObserver,
    ModelObserver,
)
from uvms_observer.disturbance.observer_config import ObserverConfig

__all__ = [
    "CombinedObserver",
    "DisturbanceObserver",
    "ModelObserver",
    "ObserverConfig",
    "external_bandwidth",
]
