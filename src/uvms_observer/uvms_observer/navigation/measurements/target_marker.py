"""A marker on the work object, seen by a camera: its pose relative to the vehicle.

With R_c the camera's axes in map_ned, its lever arm d from the IMU and the target's pose p_T, R_T,

    place:    R_c^T (p_T - p - R d) + n,
    attitude: Exp(n) R_c^T R_T.

Derivatives, the attitude's as a turn about the camera's axes:

    place:    R_c^T (dp_T - dp + [p_T - p]x dtheta),
    attitude: R_c^T (dtheta_T - dtheta).
"""

import numpy as np

from uvms_core.errors import ConfigError
from uvms_core.sensors.target_marker import MarkerSample, TargetMarker
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import (
    matrix_to_quat,
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    quat_to_rotation_vector,
    skew,
)
from uvms_observer.navigation.arrays import transposed
from uvms_observer.navigation.correction import add_error, keep_innovation
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import SIZE, NavigationState
from uvms_observer.navigation.target import (
    MOST_TARGETS,
    POSE,
    TARGET_SIZE,
    is_known,
    move_targets,
    with_target,
)


class MarkerPose(Measurement):
    """Pose of the target relative to the camera; the target's pose is part of the state.

    Each section has a target of its own, in the order of the vehicle file.
    """

    size = 6

    def __init__(self, vehicle: Vehicle, section: TargetMarker, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self._section, self._mount = section, section.sensor_axes
        floor = config.noise_floor
        least = np.repeat([floor.fix_m, np.radians(floor.attitude_deg)], 3)
        self._least = np.square(least)
        markers = [each for each in vehicle.sensors.mounted.values() if type(each) is type(section)]
        if len(markers) > MOST_TARGETS:
            raise ConfigError(
                f"the vehicle has {len(markers)} sensors of type target_marker; navigation keeps"
                f" the poses of at most {MOST_TARGETS} targets: leave some out"
            )
        self._index = next(k for k, each in enumerate(markers) if each is section)

    def begin(self, state: NavigationState) -> NavigationState:
        """With the target where the vehicle file says, or nowhere yet."""
        section = self._section
        if section.target_std_m is None:
            return with_target(state, np.zeros(3), np.zeros(4), np.zeros(TARGET_SIZE))
        std = np.repeat([section.target_std_m, np.radians(section.target_std_deg)], 3)
        place = np.array(section.target_position_m)
        return with_target(state, place, section.target_quaternion, np.square(std))

    def out_of_reach(self, state: NavigationState) -> str:
        """As `Measurement.out_of_reach`."""
        if not is_known(state, self._index):
            return "not seen yet"
        seen, attitude, _ = sight(state, self.lever, self._mount, self._index)
        normal = quat_to_matrix(attitude)[:, 2]
        return "" if self._section.recognises(seen, normal) else "out of view"

    def correct(
        self, state: NavigationState, sample: MarkerSample, rate: Array, gate: float
    ) -> float:
        """As `Measurement.correct`; the first sight of an unknown target says where it is."""
        N = self._noise(sample)
        return correct_marker(
            state,
            sample.position,
            sample.quaternion,
            N,
            self.lever,
            self._mount,
            self._index,
            gate,
        )

    def _noise(self, sample: MarkerSample) -> Array:
        """That which the message states, or that of the vehicle file."""
        stated, section = sample.covariance, self._section
        if (np.diagonal(stated) > 0.0).all():
            N = stated + np.diag(np.maximum(self._least - np.diagonal(stated), 0.0))
        else:
            std = section.noise_m + section.noise_m_per_m * float(np.linalg.norm(sample.position))
            own = np.repeat([std**2, np.radians(section.angle_noise_deg) ** 2], 3)
            N = np.diag(np.maximum(own, self._least))
        found: Array = np.ascontiguousarray(N)
        return found


@exact_inner
def sight(
    state: NavigationState, lever: Array, mount: Array, index: int
) -> tuple[Array, Array, Array]:
    """The expected place (3,) and attitude (4,) of a target, and H (6, SIZE + 6 k)."""
    R = quat_to_matrix(state.quaternion)
    to_camera = transposed(R @ mount)
    offset, arm = R @ lever, np.empty(3)
    for i in range(3):
        arm[i] = state.target[POSE * index + i] - state.position[i]
        offset[i] = arm[i] - offset[i]
    pose = state.target[POSE * index + 3 : POSE * (index + 1)]
    attitude = quat_multiply(matrix_to_quat(to_camera), pose)
    turn, H = to_camera @ skew(arm), np.zeros((6, SIZE + state.cross.shape[0]))
    own = SIZE + TARGET_SIZE * index
    for i in range(3):
        for k in range(3):
            H[i, k], H[i, own + k] = -to_camera[i, k], to_camera[i, k]
            H[i, 6 + k] = turn[i, k]
            H[3 + i, 6 + k], H[3 + i, own + 3 + k] = -to_camera[i, k], to_camera[i, k]
    return to_camera @ offset, attitude, H


@exact_kernel
def correct_marker(
    state: NavigationState,
    position: Array,
    quaternion: Array,
    N: Array,
    lever: Array,
    mount: Array,
    index: int,
    gate: float,
) -> float:
    """Pose of a target in the camera's axes, noise (6, 6), camera's lever arm and axes (3, 3)."""
    if not is_known(state, index):
        first_sight(state, position, quaternion, N, lever, mount, index)
        keep_innovation(state.innovation, np.zeros(6), N, N)  # nothing was expected
        return 0.0
    place, attitude, H = sight(state, lever, mount, index)
    turned = quat_to_rotation_vector(quat_multiply(quaternion, quat_conjugate(attitude)))
    residual = np.empty(6)
    for i in range(3):
        residual[i], residual[3 + i] = position[i] - place[i], turned[i]
    P = _joint_covariance(state)
    PHt = P @ transposed(H)
    S = H @ PHt
    for i in range(6):
        for j in range(6):
            S[i, j] += N[i, j]
    keep_innovation(state.innovation, residual, N, S)
    S_inverse = np.linalg.inv(S)
    distance = residual.dot(S_inverse @ residual)
    if not distance <= gate:
        return distance
    K = PHt @ S_inverse
    _take_covariance(state, P, K, H, N)
    e = K @ residual
    add_error(state, e)
    move_targets(state, e[SIZE:])
    return distance


@exact_inner
def _joint_covariance(state: NavigationState) -> Array:
    """Covariance (SIZE + 6 k, SIZE + 6 k) of the vehicle's state and of the targets' poses."""
    more = state.cross.shape[0]
    P = np.empty((SIZE + more, SIZE + more))
    for i in range(SIZE):
        for j in range(SIZE):
            P[i, j] = state.covariance[i, j]
    for i in range(more):
        for j in range(SIZE):
            P[SIZE + i, j] = state.cross[i, j]
            P[j, SIZE + i] = state.cross[i, j]
        for j in range(more):
            P[SIZE + i, SIZE + j] = state.target_covariance[i, j]
    return P


@exact_inner
def _take_covariance(state: NavigationState, P: Array, K: Array, H: Array, N: Array) -> None:
    """Joseph form, back into the state's three parts."""
    left = K @ H
    for i in range(P.shape[0]):
        for j in range(P.shape[0]):
            left[i, j] = (1.0 if i == j else 0.0) - left[i, j]
    kept, added = (left @ P) @ transposed(left), (K @ N) @ transposed(K)
    for i in range(P.shape[0]):
        for j in range(i + 1):
            mean = 0.5 * ((kept[i, j] + added[i, j]) + (kept[j, i] + added[j, i]))
            if i < SIZE:
                state.covariance[i, j] = mean
                state.covariance[j, i] = mean
            elif j < SIZE:
                state.cross[i - SIZE, j] = mean
            else:
                state.target_covariance[i - SIZE, j - SIZE] = mean
                state.target_covariance[j - SIZE, i - SIZE] = mean


@exact_inner
def first_sight(
    state: NavigationState,
    position: Array,
    quaternion: Array,
    N: Array,
    lever: Array,
    mount: Array,
    index: int,
) -> None:
    """The target is where it is seen: p_T = p + R d + R_c z, R_T = R_c R_z.

    With r = p_T - p: dp_T = dp - [r]x dtheta - R_c n, dtheta_T = dtheta - R_c n. What another
    target has in common with the vehicle it has in common with this one.
    """
    R = quat_to_matrix(state.quaternion)
    R_camera = R @ mount
    moved, seen = R @ lever, R_camera @ position
    arm = np.empty(3)
    for i in range(3):
        arm[i] = moved[i] + seen[i]
        state.target[POSE * index + i] = state.position[i] + arm[i]
    attitude = quat_multiply(matrix_to_quat(R_camera), quaternion)
    G, L, cross_arm = np.zeros((6, SIZE)), np.zeros((6, 6)), skew(arm)
    for i in range(4):
        state.target[POSE * index + 3 + i] = attitude[i]
    for i in range(3):
        G[i, i] = 1.0
        G[3 + i, 6 + i] = 1.0
        for k in range(3):
            G[i, 6 + k] = -cross_arm[i, k]
            L[i, k], L[3 + i, 3 + k] = R_camera[i, k], R_camera[i, k]
    common = G @ state.covariance
    own, noise = common @ transposed(G), (L @ N) @ transposed(L)
    others, first = G @ transposed(state.cross), TARGET_SIZE * index
    for i in range(TARGET_SIZE):
        for j in range(state.cross.shape[0]):
            state.target_covariance[first + i, j] = others[i, j]
            state.target_covariance[j, first + i] = others[i, j]
        for j in range(SIZE):
            state.cross[first + i, j] = common[i, j]
    for i in range(TARGET_SIZE):
        for j in range(TARGET_SIZE):
            state.target_covariance[first + i, first + j] = 0.5 * (own[i, j] + own[j, i]) + 0.5 * (
                noise[i, j] + noise[j, i]
            )
