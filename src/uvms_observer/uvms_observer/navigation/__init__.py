"""The navigation filter, eq. (20)."""

from uvms_observer.navigation.filter import NavigationFilter
from uvms_observer.navigation.navigation_config import NavigationConfig

__all__ = ["NavigationConfig", "NavigationFilter"]
