"""How the navigation filter uses each sensor: one file each, found by name in `uvms.measurements`.

Sensors are mounted at the lever arm d from the IMU (body axes), which turns with w = w_m - b_g:

    gyrocompass  R_m = R Exp(b_c + n)
    DVL          (1 + s) (1 - [m]x) (R^T v + w x d) + n, in water lock of v - c
    pressure     (p + R d)_z + b_p + n          (as depth)
    GPS          p + R d + n

The kernels give the expected reading and its derivative H (m, SIZE) by the error state, which tests
compare with finite differences, or correct the state in place: unless the residual is beyond the
gate, and they return its squared Mahalanobis distance.
"""

from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.position import correct_position

__all__ = ["Measurement", "correct_position"]
