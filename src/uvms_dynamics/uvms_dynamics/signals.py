"""Moved to `uvms_core.signals`; this name stays for a while."""

import warnings

from uvms_core.signals import *  # noqa: F403

warnings.warn(
    "uvms_dynamics.signals has moved: import uvms_core.signals", DeprecationWarning, stacklevel=2
)
