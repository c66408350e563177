"""Rotations as quaternions (x, y, z, w) and matrices, in plain Python.

A quaternion or matrix of pose `world_body` maps body components to world components. Euler angles
are roll, pitch, yaw of the ZYX sequence (Fossen 2011, sec. 2.2): only for people and files.

Written in scalars so that `uvms_dynamics.kernels.rotations` can compile these very functions with
numba; no function here calls another. scipy's `Rotation` cannot be called from compiled code, and
from Python it takes six times as long for one rotation (compiled, forty times: 0.6 against 25 us
for a matrix of a quaternion).
"""

import math

import numpy as np

_SMALL_ANGLE = 1e-6  # rad; below it the series of sin(x)/x is exact to double precision


def skew(a):
    """Cross-product matrix (3, 3): S b = a x b."""
    matrix = np.zeros((3, 3))
    matrix[0, 1], matrix[0, 2] = -a[2], a[1]
    matrix[1, 0], matrix[1, 2] = a[2], -a[0]
    matrix[2, 0], matrix[2, 1] = -a[1], a[0]
    return matrix


def quat_multiply(a, b):
    """Product a b (4,): first the rotation b, then a; R(a b) = R(a) R(b)."""
    out = np.empty(4)
    out[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1]
    out[1] = a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0]
    out[2] = a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3]
    out[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]
    return out


def quat_conjugate(a):
    """The inverse rotation (4,) of a unit quaternion."""
    out = np.empty(4)
    out[0], out[1], out[2], out[3] = -a[0], -a[1], -a[2], a[3]
    return out


def quat_normalize(a):
    """Unit quaternion (4,) along a."""
    return a / math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3])


def quat_to_matrix(a):
    """Rotation matrix (3, 3) of a unit quaternion."""
    x, y, z, w = a[0], a[1], a[2], a[3]
    out = np.empty((3, 3))
    out[0, 0] = 1.0 - 2.0 * (y * y + z * z)
    out[0, 1] = 2.0 * (x * y - z * w)
    out[0, 2] = 2.0 * (x * z + y * w)
    out[1, 0] = 2.0 * (x * y + z * w)
    out[1, 1] = 1.0 - 2.0 * (x * x + z * z)
    out[1, 2] = 2.0 * (y * z - x * w)
    out[2, 0] = 2.0 * (x * z - y * w)
    out[2, 1] = 2.0 * (y * z + x * w)
    out[2, 2] = 1.0 - 2.0 * (x * x + y * y)
    return out


def matrix_to_quat(m):
    """Unit quaternion (4,) with w >= 0 of a rotation matrix (Shepperd: by its largest part)."""
    out = np.empty(4)
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    largest = max(trace, m[0, 0], m[1, 1], m[2, 2])
    if largest == trace:
        s = 2.0 * math.sqrt(1.0 + trace)
        out[0] = (m[2, 1] - m[1, 2]) / s
        out[1] = (m[0, 2] - m[2, 0]) / s
        out[2] = (m[1, 0] - m[0, 1]) / s
        out[3] = 0.25 * s
    else:
        i = 0 if largest == m[0, 0] else (1 if largest == m[1, 1] else 2)
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2.0 * math.sqrt(1.0 + m[i, i] - m[j, j] - m[k, k])
        out[i] = 0.25 * s
        out[j] = (m[j, i] + m[i, j]) / s
        out[k] = (m[k, i] + m[i, k]) / s
        out[3] = (m[k, j] - m[j, k]) / s
    norm = math.sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2] + out[3] * out[3])
    return -out / norm if out[3] < 0.0 else out / norm


def rotation_vector_to_quat(r):
    """Unit quaternion (4,) of a turn by |r| rad about r: exp(r/2)."""
    angle = math.sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    half = 0.5 * angle
    scale = 0.5 - half * half / 12.0 if angle < _SMALL_ANGLE else math.sin(half) / angle
    out = np.empty(4)
    out[0], out[1], out[2], out[3] = scale * r[0], scale * r[1], scale * r[2], math.cos(half)
    return out


def quat_to_rotation_vector(a):
    """Rotation vector (3,) of the shorter turn, rad: the inverse of `rotation_vector_to_quat`."""
    sign = -1.0 if a[3] < 0.0 else 1.0
    norm = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    if norm < _SMALL_ANGLE:
        scale = 2.0 / (sign * a[3])
    else:
        scale = 2.0 * math.atan2(norm, sign * a[3]) / norm
    out = np.empty(3)
    out[0], out[1], out[2] = sign * scale * a[0], sign * scale * a[1], sign * scale * a[2]
    return out


def rpy_to_quat(roll, pitch, yaw):
    """Unit quaternion (4,) of Rz(yaw) Ry(pitch) Rx(roll), angles in rad."""
    cr, sr = math.cos(0.5 * roll), math.sin(0.5 * roll)
    cp, sp = math.cos(0.5 * pitch), math.sin(0.5 * pitch)
    cy, sy = math.cos(0.5 * yaw), math.sin(0.5 * yaw)
    out = np.empty(4)
    out[0] = sr * cp * cy - cr * sp * sy
    out[1] = cr * sp * cy + sr * cp * sy
    out[2] = cr * cp * sy - sr * sp * cy
    out[3] = cr * cp * cy + sr * sp * sy
    return out


def quat_to_rpy(a):
    """Roll, pitch, yaw (3,) in rad; pitch within +-pi/2."""
    x, y, z, w = a[0], a[1], a[2], a[3]
    out = np.empty(3)
    out[0] = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    out[1] = math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))
    out[2] = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return out
