"""What the figures show, in numbers."""

from collections.abc import Iterator

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_bringup.paper_figures.runs import ARM_ONLY, BLIND, FREE, MANIPULATION, OBSERVED, Runs
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_dynamics.model.arm_inertia import arm_added_inertia

SWING, ELBOW = 0, 2
FORCE, MOMENT = slice(0, 3), slice(3, 6)
ELBOW_DEG = np.linspace(0.0, 135.0, 28)
PHASE_S = 300.0
STEP_S = 0.5
"""Of the paper's planner."""
SETTLED_S = 1.0
"""From here on disturbances count: at the first tick no joint is driven, and the arm falls."""
BEGINNING_S = 16.0
"""A run so short tells whether the numbers are still those of the present code."""

Numbers = dict[str, float]


def added_inertia(vehicle: Vehicle) -> Array:
    """Of the arm about swing and shoulder axis at each of `ELBOW_DEG`, (k, 2) kg m^2."""
    q = np.zeros((len(ELBOW_DEG), vehicle.n_joints))
    q[:, ELBOW] = np.radians(ELBOW_DEG)
    return np.array([np.diag(arm_added_inertia(vehicle, angles))[:2] for angles in q])


def numbers(runs: Runs) -> Numbers:
    """Of all figures; the end of a name is the unit, none a ratio."""
    found = _fig6(load_vehicle("reference_auv"))
    found |= _fig7(runs[FREE])
    found |= _fig8(runs[BLIND], runs[OBSERVED])
    found |= _fig9_motion(runs[MANIPULATION])
    found |= _fig9_disturbance(runs[MANIPULATION], runs[ARM_ONLY])
    return found


def beginning(runs: Runs) -> Numbers:
    """Of the first `BEGINNING_S` of each run: how it moves, and what disturbs it."""
    found: Numbers = {}
    for name, run in runs.items():
        early = run.truth.time <= BEGINNING_S
        found[f"{name}.roll_max_deg"] = _most(run.rpy_deg[early, 0])
        found[f"{name}.pitch_max_deg"] = _most(run.rpy_deg[early, 1])
        found[f"{name}.restoring_rms_nm"] = _rms(_settled(run, "restoring", MOMENT, BEGINNING_S))
        found[f"{name}.tool_moves_m"] = float(np.ptp(run.end_effector[early], axis=0).max())
    return found


def _fig6(vehicle: Vehicle) -> Numbers:
    inertia = added_inertia(vehicle)
    return {
        "fig6.swing_ratio": float(inertia[-1, 0] / inertia[0, 0]),
        "fig6.shoulder_ratio": float(inertia[-1, 1] / inertia[0, 1]),
    }


def _fig7(free: Analysis) -> Numbers:
    return {
        "fig7.roll_max_deg": _most(free.rpy_deg[:, 0]),
        "fig7.pitch_max_deg": _most(free.rpy_deg[:, 1]),
        "fig7.restoring_over_coupling": _rms(_settled(free, "restoring", MOMENT))
        / _rms(_settled(free, "coupling", MOMENT)),
    }


def _fig8(blind: Analysis, observed: Analysis) -> Numbers:
    thrust = np.abs(observed.allocation.thrust)
    limits = np.array([t.greatest_n for t in observed.vehicle.thrusters])
    without = np.abs(blind.rpy_deg[:, :2]).max(axis=0)
    with_it = np.abs(observed.rpy_deg[:, :2]).max(axis=0)
    return {
        "fig8.roll_with_deg": float(with_it[0]),
        "fig8.pitch_with_deg": float(with_it[1]),
        "fig8.roll_left": float(with_it[0] / without[0]),
        "fig8.pitch_left": float(with_it[1] / without[1]),
        "fig8.restoring_max_nm": float(
            np.linalg.norm(_settled(observed, "restoring", MOMENT), axis=1).max()
        ),
        "fig8.restoring_over_coupling": _rms(_settled(observed, "restoring", MOMENT))
        / _rms(_settled(observed, "coupling", MOMENT)),
        "fig8.thrust_share": float((thrust / limits).max()),
    }


def _fig9_motion(run: Analysis) -> Numbers:
    down, forward, back = (phase(run, i) - run.target.position[0] for i in range(3))
    q_deg = np.degrees(run.joints.position)
    return {
        "fig9.down_m": float(down[-1, 2]),
        "fig9.down_sideways_mm": 1e3 * _most(down[:, :2]),
        "fig9.up_xoz_m": float(forward[0, 2] - forward[-1, 2]),
        "fig9.off_xoz_mm": 1e3 * _most(forward[:, 1]),
        "fig9.up_yoz_m": float(back[0, 2] - back[-1, 2]),
        "fig9.off_yoz_mm": 1e3 * _most(back[:, 0]),
        "fig9.return_mm": 1e3 * float(np.linalg.norm(back[-1])),
        "fig9.tracking_rms_mm": 1e3 * _rms(run.tracking_error),
        "fig9.roll_max_deg": _most(run.rpy_deg[:, 0]),
        "fig9.pitch_max_deg": _most(run.rpy_deg[:, 1]),
        "fig9.swing_step_deg": _most(np.array(list(_steps(run.joints.time, q_deg[:, SWING])))),
    }


def _fig9_disturbance(run: Analysis, arm_only: Analysis) -> Numbers:
    restoring, coupling = (_settled(run, part, MOMENT) for part in ("restoring", "coupling"))
    alone = _rms(_settled(arm_only, "restoring", MOMENT))
    force = _rms(_settled(run, "coupling", FORCE)) - _rms(_settled(run, "restoring", FORCE))
    return {
        "fig9.coupling_less_restoring_n": force,
        "fig9.restoring_over_coupling": _rms(restoring) / _rms(coupling),
        "fig9.restoring_over_coupling_alone": alone / _rms(_settled(arm_only, "coupling", MOMENT)),
        "fig9.left_of_arm_only": _rms(restoring) / alone,
    }


def phase(run: Analysis, index: int) -> Array:
    """The tool in one of the three phases, as the vehicle estimates it, (k, 3) m in map_ned."""
    tool = run.estimated_end_effector
    begin = run.path_start_s + index * PHASE_S
    inside = (tool.time >= begin) & (tool.time <= begin + PHASE_S)
    found: Array = tool.position[inside]
    return found


def _steps(time: Array, angle: Array) -> Iterator[float]:
    """How far an angle goes in each step of the paper's planner."""
    marks = np.interp(np.arange(0.0, time[-1], STEP_S), time, angle)
    yield from np.diff(marks)


def _settled(run: Analysis, part: str, rows: slice, until_s: float = np.inf) -> Array:
    """The observed force or moment of a part, (k, 3), after the first moments."""
    time = run.observed.time
    wrench: Array = getattr(run.observed, part)[(time >= SETTLED_S) & (time <= until_s)]
    return wrench[:, rows]


def _most(values: Array) -> float:
    return float(np.abs(values).max())


def _rms(vectors: Array) -> float:
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))
