"""Predict a trial: the full dynamic model, and two plain models to compare it with."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.errors import TrialError
from uvms_analysis.trials.convention import (
    JOINTS,
    down_direction,
    joint_angles,
    position_down,
    tilt_deg,
)
from uvms_analysis.trials.motion import joint_motion
from uvms_analysis.trials.read import Trial
from uvms_analysis.trials.start import TRIM_FADES_S, TRIM_STAYS, Start, measured_start
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model, build_model, restoring_wrench
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.prescribed import Load, PrescribedJoints, float_freely
from uvms_dynamics.simulation.tether import tether_load_at

_LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
_ON_ITS_SIDE = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])  # rolled by 90 degrees


class PreparedTrial(NamedTuple):
    """A trial with everything worked out that does not depend on the vehicle."""

    trial: Trial
    motion: PrescribedJoints
    samples: NDArray[np.int64]  # (k,) indices of the samples among the states
    start: Start
    depth: Array  # (k,) measured, m; used by `uvms identify` only


class Prediction(NamedTuple):
    """What a model predicts for a trial, at its samples."""

    tilt: Array  # (k, 2) roll and pitch, degrees, the trials' convention
    depth: Array  # (k,) m


def prepare_trial(trial: Trial) -> PreparedTrial:
    """The trial with its arm's motion and its initial state worked out."""
    motion, index = joint_motion(trial)
    depth = position_down(trial.position)[:, 2]
    return PreparedTrial(trial, motion, index, measured_start(trial), depth)


def drive_model(vehicle: Vehicle) -> tuple[Model, Load]:
    """Table of the vehicle, and no further load; TrialError unless its joints are the trials'."""
    names = tuple(joint.name for joint in vehicle.arm.joints)
    if names != JOINTS:
        raise TrialError(
            f"vehicle {vehicle.name} has {len(names)} joints: {', '.join(names) or 'none'}; the"
            f" trials' arm has {len(JOINTS)}: {', '.join(JOINTS)} (columns q_e, q_d, q_c, q_b)"
        )
    return build_model(vehicle), Load()


def dynamic(prepared: PreparedTrial, model: Model, load: Load, trim: bool = True) -> Prediction:
    """Integrate from the measured initial state, driven by the measured joints.

    trim: with the initial trim offset (see `trimmed`).
    """
    load = trimmed(prepared, model, load) if trim else load
    states = float_freely(model, prepared.start.state, prepared.motion, load)[prepared.samples]
    down = np.array([quat_to_matrix(quaternion)[2] for quaternion in states[:, 3:7]])
    return Prediction(tilt_deg(down), states[:, 2])


def trimmed(prepared: PreparedTrial, model: Model, load: Load) -> Load:
    """The load with the first moment that holds the vehicle at the tilt measured at the start.

    Ballast, trapped air, tether pull and marker placement differ from trial to trial. The tilt in
    which the vehicle starts at rest, compared with the model's, shows their sum: part of it stays
    for the trial, the rest fades (the best estimate of a constant plus a first-order Gauss-Markov
    process of which one value is known).
    """
    depth = prepared.start.state[2]
    first = first_moment(model, prepared.motion.q[0]) + _loaded(model, load, depth)
    measured = down_direction(prepared.start.tilt)
    added = first[2] * measured / measured[2] - first
    return load._replace(
        moment=load.moment + TRIM_STAYS * added,
        moment_fading=(1.0 - TRIM_STAYS) * added,
        fading_time=TRIM_FADES_S,
    )


def quasi_static(prepared: PreparedTrial, model: Model, load: Load, depth: Array) -> Prediction:
    """Balance of weight and buoyancy at every sample, depth (k,) given; no initial state."""
    angles = joint_angles(prepared.trial.alpha)
    moments = [
        first_moment(model, q) + _loaded(model, load, d) for q, d in zip(angles, depth, strict=True)
    ]
    return Prediction(tilt_deg(_direction(np.array(moments))), depth)


def constant(prepared: PreparedTrial) -> Prediction:
    """The initial attitude and depth, throughout."""
    count = len(prepared.trial.t)
    depth = np.full(count, prepared.start.state[2])
    return Prediction(np.tile(prepared.start.tilt, (count, 1)), depth)


def first_moment(model: Model, q: Array) -> Array:
    """Sum of position times weight less buoyancy (3,), N m, body frame.

    Read off two attitudes: m x (0, 0, 1) = (m_y, -m_x, 0) and m x (0, 1, 0) = (-m_z, 0, m_x).
    """
    level = restoring_wrench(model, _LEVEL, q)
    side = restoring_wrench(model, _ON_ITS_SIDE, q)
    return np.array([-level[4], level[3], -side[3]])


def _loaded(model: Model, load: Load, depth: float) -> Array:
    """First moment (3,) of the load and of the vehicle's tether."""
    return np.asarray(load.moment + np.array(tether_load_at(model, len(JOINTS), depth)[1:]))


def _direction(moment: Array) -> Array:
    """Down at rest: weight hangs below buoyancy, along the first moment."""
    return np.asarray(moment / np.linalg.norm(moment, axis=-1, keepdims=True))
