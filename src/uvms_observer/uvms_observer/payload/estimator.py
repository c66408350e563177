"""The payload in the gripper: noticed, weighed and let go of, from unexplained forces."""

import numpy as np

from uvms_core.signals import Array, Payload
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.frames import arm_frames, mounting_pose
from uvms_dynamics.payload import COLUMNS
from uvms_observer.payload.fit import fit, most_likely, theta_of, without_mass
from uvms_observer.payload.step_search import (
    CANDIDATES,
    FORGET,
    follow_block,
    likelihood_of_step,
)

BLOCK_S = 0.25
"""Ticks are averaged over this time: the differences of noisy velocities then add up to that at its
ends, so that the noise falls with the time itself."""
LEAST_BLOCKS = 3
"""A change is judged when it has been seen in as many whole blocks."""
LIKELY = 60.0
"""Least 2 ln(ratio): chi-square of five, exceeded once in 1e11 blocks where nothing is held."""
EXPLAINED = 0.9
"""Least share of the change since the grasp that the payload explains. A current, a dead thruster
or a stuck joint leaves more: its forces are not those of a weight in the tool."""
SIGNIFICANT = 5.0
"""Least weight over its std, and most standard deviations that place and mass may be from what is
known of any payload."""
GRIP = 0.1
"""The centre of what is held lies this share of the arm's length from the tool (1 std, each axis).
It decides only what the forces leave open."""
VIRTUAL_MASS = 3.0, 2.0
"""Virtual mass over weight / g, and its std: a body of 1.3 to 8 times the density of water, with
half of its water as added mass, has (s + 1/2) / (s - 1) = 6 to 1.2. What is lighter than water, and
so weighs less than nothing, can be held too."""


class PayloadEstimator:
    """Looks for a payload, block by block; sees one that comes, not one that was always there.

    What the model lacks at the start, and what changes slowly, is taken for an error of the model.
    For the first 5 s it learns how large those are, and confirms nothing.

    Args:
        vehicle: joints, length of the arm, gravity.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        rows, count = 6 + vehicle.n_joints, CANDIDATES + 1  # the last one: the payload held
        gravity = vehicle.environment.gravity_m_s2
        self._known = np.array(
            [GRIP * arm_length(vehicle), VIRTUAL_MASS[0] / gravity, VIRTUAL_MASS[1] / gravity]
        )
        self._offset, self._B = np.zeros((count, rows)), np.zeros((count, rows, COLUMNS))
        self._L, self._d = np.zeros((count, COLUMNS, COLUMNS)), np.zeros((count, COLUMNS))
        self._energy, self._felt = np.zeros(count), np.zeros(count)
        self._b, self._s = np.zeros(rows), np.zeros(rows)
        self._y, self._S = np.zeros(rows), np.zeros((rows, COLUMNS))
        self._time, self._blocks, self._seen = 0.0, 0, 0
        self._phi = np.zeros(5)
        self.theta = np.zeros(COLUMNS)
        """(w, w p, m, m p) of the payload that is held; zero for none."""
        self.payload = NOTHING_HELD

    def step(self, dt: float, unexplained: Array, forces: Array, noise: Array) -> bool:
        """Take in what is unexplained over dt s; True where `payload` is new.

        Args:
            dt: s.
            unexplained: (6+n,) mean force over dt beyond model (without payload) and drives.
            forces: (6+n, 8) as of `payload_forces`.
            noise: (6+n,) variances of the momentum by the noise of the velocities, (N s)^2.
        """
        self._y += dt * unexplained
        self._S += dt * forces
        self._time += dt
        if self._time < BLOCK_S - 0.5 * dt:
            return False
        self._take_in(self._y / self._time, self._S / self._time, 2.0 * noise / self._time**2)
        self._time = 0.0
        self._y[:] = 0.0
        self._S[:] = 0.0
        return True

    def _take_in(self, y: Array, S: Array, variances: Array) -> None:
        if self._blocks == 0:
            self._b, self._s = y.copy(), variances.copy()
        newest = self._seen % CANDIDATES
        self._blocks += 1
        self._seen += 1
        follow_block(
            y, S, variances, self._b, self._s, self.theta,
            self._offset, self._B, self._L, self._d, self._energy, self._felt, newest,
        )  # fmt: skip
        if self._blocks > 1.0 / FORGET and self._energy[:-1].max() > LIKELY:
            self._decide(newest, y)
        if self.payload.held:
            self._phi, covariance, _ = fit(self._L[-1], self._d[-1], self._phi, self._known, 2)
            self._hold(self._phi, covariance)

    def _decide(self, newest: int, y: Array) -> None:
        if self.payload.held and self._is_let_go(newest):
            self._let_go(y)
            return
        c, phi, covariance, ratio = most_likely(
            self._L[:-1], self._d[:-1], self._energy[:-1], self._known, LIKELY
        )
        if self._is_ripe(c, newest) and ratio > EXPLAINED * self._energy[c]:
            self._grasp(c, phi, covariance)

    def _is_ripe(self, c: int, newest: int) -> bool:
        """Whether a candidate has been seen long enough, by the joints as well as by the hull."""
        is_old = c >= 0 and (newest - c) % CANDIDATES >= LEAST_BLOCKS
        return is_old and self._felt[c] > LIKELY

    def _is_let_go(self, newest: int) -> bool:
        """Whether the loss of all that is held explains a change."""
        ratios = [
            likelihood_of_step(self._L[c], self._d[c], -self.theta) for c in range(CANDIDATES)
        ]
        c = int(np.argmax(ratios))
        return (
            self._is_ripe(c, newest)
            and ratios[c] > LIKELY
            and ratios[c] > EXPLAINED * self._energy[c]
        )

    def _grasp(self, c: int, phi: Array, covariance: Array) -> None:
        """Take the step of candidate c, on top of what is held, if a payload can be so.

        What was learned of the mass in these blocks is dropped: the jerk of the grasp is in them.
        """
        change = theta_of(phi)
        theta = self.theta + change
        whole = np.concatenate((theta[:1], theta[1:4] / theta[0], theta[4:5]))
        if not self._is_possible(whole, covariance):
            return
        self._b -= self._offset[-1] + self._B[-1] @ self.theta
        self._b -= self._offset[c] + self._B[c] @ change
        own = without_mass(self._L[c])
        self._forget_candidates()
        self._L[-1], self._d[-1] = own, own @ theta
        self._phi = whole
        self._hold(whole, covariance)

    def _is_possible(self, phi: Array, covariance: Array) -> bool:
        size, spread = max(abs(phi[0]), 1e-9), np.sqrt(covariance.diagonal())
        place = np.abs(phi[1:4]) / self._known[0]
        mass = abs(phi[4] / size - self._known[1]) / self._known[2]
        is_a_body = phi[4] > 0.0  # the step of a grasp in motion can look as if it had none
        return bool(
            is_a_body
            and size > SIGNIFICANT * spread[0]
            and place.max() < SIGNIFICANT
            and mass < SIGNIFICANT
        )

    def _let_go(self, y: Array) -> None:
        self._forget_candidates()
        self._b, self._phi = y.copy(), np.zeros(5)
        self.theta, self.payload = np.zeros(COLUMNS), NOTHING_HELD

    def _forget_candidates(self) -> None:
        for table in (self._energy, self._felt, self._L, self._d, self._B, self._offset):
            table[:] = 0.0

    def _hold(self, phi: Array, covariance: Array) -> None:
        w, x, y, z, mass = phi.tolist()
        sigma = np.sqrt(covariance.diagonal())
        place = np.array((x, y, z))
        self.theta = theta_of(phi)
        self.payload = Payload(
            True, mass, float(sigma[4]), w, float(sigma[0]), place, sigma[1:4].copy()
        )


NOTHING_HELD = Payload(False, 0.0, 0.0, 0.0, 0.0, np.zeros(3), np.zeros(3))


def arm_length(vehicle: Vehicle) -> float:
    """Length of the stretched arm from its first joint to the tool, m."""
    origins = [origin for origin, _ in arm_frames(vehicle.arm, np.zeros(vehicle.n_joints))[1:]]
    links = np.linalg.norm(np.diff(origins, axis=0), axis=1)
    return float(links.sum() + np.linalg.norm(mounting_pose(vehicle.arm.tool)[0]))
