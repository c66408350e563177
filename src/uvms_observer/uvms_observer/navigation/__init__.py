"""The navigation filter, eq. (20)."""

from uvms_observer.navigation.config import NavigationConfig
from uvms_observer.navigation.filter import NavigationFilter

__all__ = ["NavigationConfig", "NavigationFilter"]
