"""Random filter states and noise for tests of the kernels."""

import numpy as np
from scipy.spatial.transform import Rotation

from uvms_dynamics.kernels.rotations import quat_conjugate, quat_multiply, quat_to_rotation_vector
from uvms_observer.navigation.propagation import ProcessNoise
from uvms_observer.navigation.state import FURTHER, SIZE, WIDEST, NavigationState

NOISE = ProcessNoise(
    1e-6,
    1e-4,
    0.01,
    np.linspace(1e-6, 9e-6, SIZE - 9),
    1.0 / np.linspace(100.0, 900.0, SIZE - 9),
)
SCALES = np.repeat([1.0, 0.1, 0.02, 1e-3, 1e-2, 2e-3, 1e-2], [3, 3, 3, 3, 3, 3, SIZE - 18])


def random_state(seed):
    """A state of a moving vehicle with a full covariance."""
    rng = np.random.default_rng(seed)
    root = SCALES[:, None] * rng.standard_normal((SIZE, SIZE)) / np.sqrt(SIZE)
    tilt = np.array([rng.uniform(-3, 3), *rng.uniform(-0.5, 0.5, 2)])
    velocity = rng.standard_normal(3)
    return NavigationState(
        10.0 * rng.standard_normal(3),
        velocity,
        Rotation.from_euler("ZYX", tilt).as_quat(),
        0.01 * rng.standard_normal(3),
        0.1 * rng.standard_normal(3),
        0.01 * rng.standard_normal(3),
        0.01 * rng.standard_normal(SIZE - FURTHER),
        root @ root.T,
        np.zeros((3, WIDEST)),
        velocity.copy(),
        np.square([0.01, 0.02, 0.03, 0.1, 0.2, 0.3]),
    )


def minus(a, b):
    """Error e (SIZE,) with a = b (+) e."""
    turn = quat_to_rotation_vector(quat_multiply(a.quaternion, quat_conjugate(b.quaternion)))
    rest = [x - y for x, y in zip(a[3:7], b[3:7], strict=True)]
    return np.concatenate((a.position - b.position, a.velocity - b.velocity, turn, *rest))


def numeric_jacobian(f, h=1e-5):
    """Derivative (m, SIZE) of f(e) at zero, central differences."""
    columns = [(f(h * e) - f(-h * e)) / (2.0 * h) for e in np.eye(SIZE)]
    return np.array(columns).T
