"""Whether a vehicle is upright, for /diagnostics."""

import numpy as np

from uvms_core.checks import ATTITUDE_DEG
from uvms_core.diagnostics import OK, WARN
from uvms_core.rotations import quat_to_rpy
from uvms_core.signals import Array


def attitude_status(quaternion: Array) -> tuple[int, str]:
    """Level and message: WARN where roll or pitch is beyond `ATTITUDE_DEG`.

    Args:
        quaternion: of the pose of the body in map_ned (4,), x y z w.
    """
    roll, pitch, _ = np.rad2deg(quat_to_rpy(quaternion))
    if max(abs(roll), abs(pitch)) <= ATTITUDE_DEG:
        return OK, "ok"
    return WARN, f"roll {roll:.0f} deg, pitch {pitch:.0f} deg: beyond {ATTITUDE_DEG:g} deg"
