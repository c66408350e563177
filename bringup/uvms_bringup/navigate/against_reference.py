"""The estimate against a reference in the same log: errors of position and attitude."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uvms_analysis.log.definition import UNDECODABLE
from uvms_bringup.navigate.bag import Bag
from uvms_core.messages.fields import stamp_of
from uvms_core.signals import Array, Odometry, to_nanoseconds
from uvms_core.topic import WORLD_FRAME
from uvms_core.world_frames import R_MAP_MAP_NED
from uvms_dynamics.kernels.rotations import quat_multiply, quat_to_matrix

FARTHEST = to_nanoseconds(0.5)
"""Two poses of the reference farther apart than this, ns, are not joined by a line."""
SIGMAS = 3.0
HALF_TURN = np.sqrt(0.5) * np.array([1.0, 1.0, 0.0, 0.0])
"""Quaternion of `R_MAP_MAP_NED`: half a turn about the diagonal of its first two axes."""
OVER = np.array([1.0, 0.0, 0.0, 0.0])
"""Half a turn about x: from forward-left-up to forward-starboard-down, and back."""


@dataclass(frozen=True)
class Track:
    """Poses over time in map_ned and forward-starboard-down."""

    stamps: np.ndarray  # (k,) ns, increasing
    position: Array  # (k, 3) m
    quaternion: Array  # (k, 4)
    frame: str  # as the messages name it
    is_enu: bool  # whether they were taken for east-north-up and forward-left-up


def read_track(bag: Bag, topic: str, use_log_time: bool = False) -> Track | None:
    """The reference of a log, from Odometry or PoseStamped; None without a valid pose.

    A frame called map_ned has our axes; any other is taken for REP-103's, east-north-up with a body
    forward-left-up, as all of ROS has it.
    """
    decode, found, frame = bag.decoder(topic), {}, ""
    for one in bag.messages([topic]):
        try:
            message = decode(one.data)
            stamp = one.logged if use_log_time else stamp_of(message.header.stamp)
            pose = _pose(message)
        except UNDECODABLE:
            continue
        if np.isfinite(pose).all() and abs(pose[3:].dot(pose[3:]) - 1.0) < 1e-2:
            found[stamp], frame = pose, message.header.frame_id
    if not found:
        return None
    stamps = np.array(sorted(found), dtype=np.int64)
    poses = np.array([found[int(stamp)] for stamp in stamps])
    is_enu = frame != WORLD_FRAME
    position, quaternion = poses[:, :3], poses[:, 3:]
    if is_enu:
        position = position @ R_MAP_MAP_NED  # which is symmetric
        quaternion = np.array([_to_ned(each) for each in quaternion])
    return Track(stamps, position, quaternion, frame, is_enu)


def _pose(message: Any) -> Array:
    """Position and quaternion (7,) of an Odometry or a PoseStamped."""
    pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
    p, q = pose.position, pose.orientation
    return np.array([p.x, p.y, p.z, q.x, q.y, q.z, q.w])


def _to_ned(quaternion: Array) -> Array:
    """Forward-left-up to east-north-up as forward-starboard-down to north-east-down."""
    return quat_multiply(quat_multiply(HALF_TURN, quaternion), OVER)


def at(track: Track, stamps: np.ndarray) -> tuple[np.ndarray, Array, Array]:
    """The reference at other stamps: which of these it has (bool), position and quaternion there.

    Between two poses the position is on a line and the attitude on the shortest turn, to third
    order in the turn.
    """
    after = np.clip(np.searchsorted(track.stamps, stamps), 1, max(len(track.stamps) - 1, 1))
    if len(track.stamps) < 2:
        return np.zeros(len(stamps), dtype=bool), np.zeros((0, 3)), np.zeros((0, 4))
    t0, t1 = track.stamps[after - 1], track.stamps[after]
    inside = (t0 <= stamps) & (stamps <= t1) & (t1 - t0 <= FARTHEST)
    after, stamps = after[inside], stamps[inside]
    t0, t1 = t0[inside], t1[inside]
    part = ((stamps - t0) / (t1 - t0))[:, None]
    position = track.position[after - 1] + part * (
        track.position[after] - track.position[after - 1]
    )
    q0, q1 = track.quaternion[after - 1], track.quaternion[after]
    sign = np.sign(np.sum(q0 * q1, axis=1, keepdims=True))
    quaternion = (1.0 - part) * q0 + part * np.where(sign < 0.0, -q1, q1)
    return inside, position, quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)


def errors(estimates: list[Odometry], track: Track) -> dict[str, Any] | None:
    """Errors of the estimates that the reference covers; None where it covers none.

    Position: estimated minus reference, m, map_ned. Attitude: the rotation vector between the two,
    rad, about map_ned axes. Both against the covariance in the estimate's message.
    """
    stamps = np.array([each.stamp for each in estimates], dtype=np.int64)
    inside, position, quaternion = at(track, stamps)
    if not inside.any():
        return None
    own = [each for each, there in zip(estimates, inside, strict=True) if there]
    off = np.array([each.position for each in own]) - position
    turn = np.array([_turn(e.quaternion, q) for e, q in zip(own, quaternion, strict=True)])
    std = np.sqrt(np.array([np.diagonal(each.pose_covariance) for each in own]))
    path = float(np.linalg.norm(np.diff(position, axis=0), axis=1).sum())
    distance, angle = np.linalg.norm(off, axis=1), np.degrees(np.linalg.norm(turn, axis=1))
    return {
        "compared": int(inside.sum()),
        "distance_travelled_m": path,
        "position_error_m": _figures(distance),
        "position_std_m": {"median": float(np.median(np.linalg.norm(std[:, :3], axis=1)))},
        "position_inside_3_sigma": _share(off, std[:, :3]),
        "attitude_error_deg": _figures(angle),
        "attitude_inside_3_sigma": _share(turn, std[:, 3:]),
    }


def _turn(estimated: Array, true: Array) -> Array:
    """Rotation vector (3,) from the true to the estimated attitude, world axes."""
    R = quat_to_matrix(estimated) @ quat_to_matrix(true).T
    axis = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine, cosine = float(np.linalg.norm(axis)), 0.5 * (float(np.trace(R)) - 1.0)
    angle = np.arctan2(sine, cosine)
    return axis if sine < 1e-12 else axis * (angle / sine)


def _figures(values: Array) -> dict[str, float]:
    median, most = np.percentile(values, [50.0, 95.0])
    return {
        "median": float(median),
        "rms": float(np.sqrt(np.mean(values**2))),
        "p95": float(most),
        "max": float(values.max()),
        "end": float(values[-1]),
    }


def _share(error: Array, std: Array) -> float:
    """Share of samples within three standard deviations along all axes."""
    return float((np.abs(error) <= SIGMAS * std).all(axis=1).mean())
