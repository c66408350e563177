"""Motion of the tool relative to the vehicle, from the joints' motion."""

import numpy as np

from uvms_dynamics.kernels.chain import joint_frames
from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import TOOL_POSITION, TOOL_ROTATION
from uvms_dynamics.kernels.spatial import cross, load3

FRAME_COLUMNS = 12
ORIGIN = np.int64(9)


@inner
def tool_motion(model, motion, frames, out):
    """Fill `out` (3, 3) with position, velocity and acceleration of the tool in the body frame.

    motion (3, 1 + n) holds yaw and joints, their rates and their accelerations in its rows; frames
    (n + 1, 12) is filled on the way. Eq. (2)-(7) without the vehicle's own motion.
    """
    n = motion.shape[1] - 1
    joint_frames(model, motion[0, 1:], frames)
    w, al, v, a = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for i in range(1, n + 1):
        rate, bend = motion[1, i], motion[2, i]
        turn = (rate * frames[i, 2], rate * frames[i, 5], rate * frames[i, 8])
        g = cross(w, turn)
        al = (
            al[0] + bend * frames[i, 2] + g[0],
            al[1] + bend * frames[i, 5] + g[1],
            al[2] + bend * frames[i, 8] + g[2],
        )
        w = (w[0] + turn[0], w[1] + turn[1], w[2] + turn[2])
        if i < n:
            x = frames[i + 1, ORIGIN] - frames[i, ORIGIN]
            y = frames[i + 1, ORIGIN + 1] - frames[i, ORIGIN + 1]
            z = frames[i + 1, ORIGIN + 2] - frames[i, ORIGIN + 2]
        else:
            p = load3(model, n + 1, TOOL_POSITION)
            x, y, z = in_body(frames, n, p[0], p[1], p[2])
            for k in range(3):
                out[0, k] = frames[n, ORIGIN + k]
            out[0, 0], out[0, 1], out[0, 2] = out[0, 0] + x, out[0, 1] + y, out[0, 2] + z
        swept = cross(w, (x, y, z))
        gain, pull = cross(al, (x, y, z)), cross(w, swept)
        v = (v[0] + swept[0], v[1] + swept[1], v[2] + swept[2])
        a = (a[0] + gain[0] + pull[0], a[1] + gain[1] + pull[1], a[2] + gain[2] + pull[2])
    for k in range(3):
        out[1, k], out[2, k] = v[k], a[k]


@inner
def in_body(frames, i, x, y, z):
    """Components in the body frame of a vector of frame i."""
    return (
        frames[i, 0] * x + frames[i, 1] * y + frames[i, 2] * z,
        frames[i, 3] * x + frames[i, 4] * y + frames[i, 5] * z,
        frames[i, 6] * x + frames[i, 7] * y + frames[i, 8] * z,
    )


@inner
def tool_axes(model, frames, n, yaw, out):
    """Fill `out` (3, 3) with the rotation of the tool in the world, for a level vehicle."""
    c, s = np.cos(yaw), np.sin(yaw)
    for column in range(3):
        k = TOOL_ROTATION + column
        x, y, z = in_body(frames, n, model[n + 1, k], model[n + 1, k + 3], model[n + 1, k + 6])
        out[0, column], out[1, column], out[2, column] = c * x - s * y, s * x + c * y, z
