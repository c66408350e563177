"""Thrust tells the velocity where no sensor does, with an offset for water and model.

A hull whose thrusts are known (`hull_motion.py`) moves through the water with v_r. Over ground,

    v + o = R (v_r + omega x d),      d: from the body origin to the inertial unit,

where the offset o has the current in it and all that the model is wrong by (Hegrenaes and
Hallingstad, *Model-aided INS with sea current estimation*, 2011). From the moment on at which it
counts, o is a state beside the others, known as well as the velocity is then (`lasting.py`), so
that only what it changes by matters: by a force that the model does not know (random walk), and,
where thrust and drag are wrong by a share, by that share of what v_r has changed by. Where the
model contradicts the inertial unit, by one sample or by the mean of many, something else moves or
holds the vehicle: the model is given up, and all that it has said is doubted.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.plausibility.agility import agility_of
from uvms_core.signals import Allocation, Array, Odometry, to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.resistance import axis_resistance
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.measurements.base import Linear
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import ATTITUDE, POSITION, SIZE, VELOCITY, NavigationState
from uvms_observer.navigation.trust import lasting
from uvms_observer.navigation.trust.hull_motion import HullMotion, ModelVelocity
from uvms_observer.navigation.trust.innovation_gate import JUMP, quantile
from uvms_observer.navigation.trust.lasting import AXES, OWN
from uvms_observer.navigation.trust.top_speed import EVERY, MOST_M_S

LASTS_S = 45.0
"""How long a force that the model does not know stays as it is, s: a tether's, or trim. The offset
walks as one that is correlated so long does at first, but not to zero: most of it is current."""
MEAN_S = 5.0
"""Over which the residuals are averaged, s."""
BEGIN = 0.25
"""Of the offset's std: from here on an inertial unit left alone is worse than the model."""
END = 0.1
"""And from here on a sensor tells the velocity again."""
TOO_FAR = 3.0
"""Standard deviations of water and model together; a hull that is held is farther off."""
LEAST_M_S = 0.01
"""Std of the velocity below which the model is not asked."""
MANY = 2
"""Samples in a row that cannot be, by which the model is wrong."""
TINY = 1e-9
LEVEL = np.diag([1.0, 1.0, 0.0])
NOISE_M_S = np.array([0.01, 0.01, 1.0])
"""North, east, down. The depth tells the last better than a model that does not know the trim."""


class HullModel(NamedTuple):
    """The model of a vehicle, and how far it is trusted."""

    motion: HullMotion
    share: float  # by which thrust and drag may be wrong
    force: Array  # (2,) N, std of the force ahead and abeam that it does not know
    linear: Array  # (2,) N s/m, resistance ahead and abeam
    quadratic: Array  # (2,) N s^2/m^2
    lever: Array  # (3,) m, of the inertial unit, body axes
    current: float  # m/s, std of the water's velocity

    def std(self, speed: Array) -> Array:
        """Of the offset's changes in the long run, (2,) m/s, at a speed (2,) ahead and abeam.

        By how much the unknown force makes the vehicle faster than it is.
        """
        a, b, speed = self.linear, self.quadratic, np.abs(speed)
        pull = a * speed + b * speed**2 + self.force
        faster = 2.0 * pull / (a + np.sqrt(a**2 + 4.0 * b * pull) + TINY) - speed
        return np.minimum(faster, MOST_M_S)


def hull_model(vehicle: Vehicle, config: NavigationConfig) -> HullModel:
    """The model of this vehicle, as uncertain as the configuration says."""
    linear, quadratic = axis_resistance(vehicle.hull, vehicle.environment.water_density_kg_m3)
    _try(HullMotion(vehicle), len(vehicle.thrusters))
    return HullModel(
        HullMotion(vehicle),
        np.sqrt(2.0) * config.hull_model_error,  # of thrust and of drag
        config.unmodelled_force * agility_of(vehicle).wrench[:2],
        linear[:2],
        quadratic[:2],
        np.array(vehicle.sensors.imu.position_m),
        config.current_std_m_s,
    )


def _try(motion: HullMotion, thrusters: int) -> None:
    """Have the kernel compiled before the first loss, in the midst of which nobody can wait."""
    none = np.zeros(6)
    wide = np.zeros((6, 6))
    motion.inform(Allocation(0, np.zeros(thrusters), none, none, np.zeros(thrusters, bool)))
    motion.note(EVERY, Odometry(0, np.zeros(3), lasting.NO_TURN, none, wide, wide))
    motion.at(EVERY)


class Driven(NamedTuple):
    """What is kept while the thrusts tell the velocity."""

    stamp: int  # ns, of the last use
    begun: Array  # (3,) m/s, what the model said at first, map_ned
    since: int  # ns, when that was
    changed: float = 0.0  # m/s, farthest from that so far
    away: int = 0  # samples in a row that cannot be
    residual: Array = np.zeros(AXES)  # sum of the residuals, each over its std, fading
    weight: float = 0.0  # variance of that sum where the model is right


class Aided(NamedTuple):
    """The state; what is kept, if the thrusts tell the velocity; whether the model is wrong."""

    state: NavigationState
    kept: Driven | None
    wrong: bool = False


def aided(state: NavigationState, kept: Driven | None, model: HullModel, stamp: int) -> Aided:
    """The state at `stamp` (ns) after the model has been heard; nothing is kept where it is not."""
    worst = velocity_std(state)
    told = model.motion.at(stamp) if kept is not None or worst > LEAST_M_S else None
    if told is None:
        return Aided(_without(state, kept), None)
    std = model.std(told.velocity[:2])
    sample = _sample(state, model, told)
    through = quat_to_matrix(state.quaternion) @ told.velocity
    if kept is None:
        if worst < BEGIN * std.max() or not lasting.has_room(state):
            return Aided(state, None)
        speed = min(_size(through), _size(state.velocity))  # one that is held has none
        allowed = np.hypot(model.current, np.hypot(std.max(), model.share * speed))
        if _size(sample.residual) > TOO_FAR * np.hypot(allowed, worst):
            return Aided(state, None, wrong=True)
        return Aided(lasting.with_offset(state, sample), Driven(stamp, through, stamp))
    if worst < END * std.max():
        return Aided(lasting.without_offset(state), None)
    kept = _aged(state, kept, model, std, through, stamp)
    change, spread = lasting.expected(state, sample)
    kept = _judged(kept, np.linalg.solve(np.linalg.cholesky(spread), change))
    mean = float(kept.residual @ kept.residual) / kept.weight
    if kept.away >= MANY or mean > quantile(AXES, JUMP):
        return Aided(_doubted(lasting.without_offset(state), kept), None, wrong=True)
    if not kept.away:
        lasting.correct_by_changes(state, sample)
    return Aided(state, kept)


def _judged(kept: Driven, residual: Array) -> Driven:
    """After a residual (3,), each over its std."""
    fades = np.exp(-EVERY / to_nanoseconds(MEAN_S))
    is_away = float(residual @ residual) > quantile(AXES, JUMP)
    return kept._replace(
        away=kept.away + 1 if is_away else 0,
        residual=fades * kept.residual + residual,
        weight=fades**2 * kept.weight + 1.0,
    )


def _doubted(state: NavigationState, kept: Driven) -> NavigationState:
    """Whatever the model has changed by may have been wrong: by so much the estimate is worse."""
    gone = to_seconds(kept.stamp - kept.since)
    state.covariance[VELOCITY, VELOCITY] += kept.changed**2 * LEVEL
    state.covariance[POSITION, POSITION] += (0.5 * gone * kept.changed) ** 2 * LEVEL
    return state


def velocity_std(state: NavigationState) -> float:
    """The greater of north and east, m/s."""
    P = state.covariance[VELOCITY, VELOCITY]
    return float(np.sqrt(max(P[0, 0], P[1, 1])))


def _sample(state: NavigationState, model: HullModel, told: ModelVelocity) -> Linear:
    """What the model says about the estimate."""
    R = quat_to_matrix(state.quaternion)
    moves = R @ (told.velocity + np.cross(told.rate, model.lever))
    H = np.zeros((AXES, SIZE))
    H[:, VELOCITY] = np.eye(AXES)
    H[:, ATTITUDE] = skew(moves)
    return Linear(moves - state.velocity, H, np.diag(NOISE_M_S**2))


def _aged(
    state: NavigationState, kept: Driven, model: HullModel, std: Array, through: Array, stamp: int
) -> Driven:
    """Carry the offset to the stamp, in place."""
    changed = max(kept.changed, _size(through - kept.begun))
    R = quat_to_matrix(state.quaternion)[:, :2]
    added = 2.0 * to_seconds(stamp - kept.stamp) / LASTS_S * (R * std**2) @ R.T
    added += model.share**2 * (changed**2 - kept.changed**2) * np.eye(AXES)
    state.target_covariance[OWN, OWN] += added
    return kept._replace(stamp=stamp, changed=changed)


def _without(state: NavigationState, kept: Driven | None) -> NavigationState:
    return state if kept is None else lasting.without_offset(state)


def _size(velocity: Array) -> float:
    return float(np.hypot(velocity[0], velocity[1]))
