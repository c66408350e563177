"""Trials made by the model itself, so that what they must show is known."""

from pathlib import Path

import numpy as np

from uvms_analysis.trials.convention import JOINT_ZERO_RAD, SURFACE_Z_M
from uvms_analysis.trials.motion import joint_motion
from uvms_analysis.trials.predict import drive_model, first_moment, tilt_deg
from uvms_analysis.trials.read import Trial
from uvms_analysis.trials.start import measured_start
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.locate import known_vehicles
from uvms_dynamics import quat_to_matrix, quat_to_rpy, rpy_to_quat
from uvms_dynamics.simulation.prescribed import float_freely

ROOT = Path(__file__).parents[2]
DATA = ROOT / "bringup" / "data" / "pool_trials"
VEHICLE = known_vehicles()["bluerov2_alpha5"]
HEADER = "t,x,y,z,roll,pitch,yaw,gx,gy,gz,q_b,q_c,q_d,q_e"


def made_trial(vehicle: Vehicle, seed: int, noise_deg: float = 0.0, arm: bool = True) -> Trial:
    """16 s at 25 Hz: the arm goes from one random pose to another and back; it starts at rest."""
    rng = np.random.default_rng(seed)
    t = np.arange(401) * 0.04
    low, high = np.radians([[-70, 10, 10, -90], [70, 120, 150, 90]])
    ends = rng.uniform(low, high, (2, 4))
    part = 0.5 - 0.5 * np.cos(np.pi * np.clip((t - 2.0) / 5.0, 0.0, 2.0)) if arm else 0.0 * t
    angles = ends[0] + part[:, None] * (ends[1] - ends[0])
    blank = Trial(
        f"made{seed}", t, np.zeros((401, 3)), np.zeros((401, 3)), np.zeros((401, 3)),
        angles + JOINT_ZERO_RAD, np.ones(401, dtype=bool),
    )  # fmt: skip
    model, load = drive_model(vehicle)
    motion, index = joint_motion(blank)
    start = measured_start(blank).state
    start[2] = rng.uniform(0.4, 1.0)
    moment = first_moment(model, motion.q[0])
    if (tether := vehicle.tether) is not None:
        below = start[2] - tether.reference_depth_m
        moment = moment + np.array(tether.moment_per_m_nm) * below
    roll, pitch = np.radians(tilt_deg(moment / np.linalg.norm(moment)))
    start[3:7] = rpy_to_quat(roll, -pitch, 0.3)
    states = float_freely(model, start, motion, load)[index]
    return _measured(blank, states, noise_deg * _wander(rng, len(t)))


def _wander(rng, count):
    """Correlated noise of unit variance, as real residuals are."""
    white = rng.normal(size=(count + 50, 2))
    smooth = np.array([np.convolve(column, np.ones(51), "valid") for column in white.T]).T
    return smooth / np.sqrt(51.0)


def _measured(blank: Trial, states, noise) -> Trial:
    rpy = np.degrees([quat_to_rpy(quaternion) for quaternion in states[:, 3:7]])
    attitude = rpy * np.array([1.0, -1.0, -1.0])
    attitude[:, :2] += noise
    position = states[:, :3] * np.array([1.0, -1.0, -1.0]) + np.array([0.0, 0.0, SURFACE_Z_M])
    gyro = states[:, 10:] * np.array([1.0, -1.0, -1.0])
    return Trial(blank.name, blank.t, position, attitude, gyro, blank.alpha, blank.accepted)


def write_trial(trial: Trial, folder: Path) -> Path:
    """The trial as a CSV with no more than the columns that must be."""
    path = folder / f"{trial.name}.csv"
    alpha = trial.alpha[:, ::-1]
    rows = np.column_stack([trial.t, trial.position, trial.attitude, trial.gyro, alpha])
    np.savetxt(path, rows, fmt="%.8g", delimiter=",", header=HEADER, comments="")
    return path


def body_matrix(quaternion_wxyz):
    """Rotation matrix of a quaternion in the trials' order w, x, y, z."""
    return quat_to_matrix(np.roll(quaternion_wxyz, -1))
