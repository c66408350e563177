"""The navigation filter, eq. (20)."""

from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.filter import NavigationFilter
from uvms_observer.navigation.measurements import Measurement, correct_position
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import NavigationState

__all__ = [
    "Measurement",
    "NavigationConfig",
    "NavigationFilter",
    "NavigationState",
    "correct",
    "correct_position",
]
