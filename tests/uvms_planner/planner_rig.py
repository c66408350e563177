"""Vehicles, signals and a driver of the planner for its tests."""

from dataclasses import dataclass

import numpy as np
import yaml

from uvms_core.end_effector_path import PathSample
from uvms_core.signals import JointStates, Odometry, to_nanoseconds
from uvms_core.vehicle import Vehicle, dump_vehicle, load_vehicle
from uvms_core.vehicle.loader import vehicle_from_data
from uvms_planner import MotionPlanner, PathPhase, PathSpec, PlannerConfig
from uvms_planner.projection import tool_pose
from uvms_planner.solver import StepSolver

START_DEG = (0.0, 10.0, 115.0, 0.0)
START = np.concatenate([[0.0, 0.0, 10.0, 0.0], np.deg2rad(START_DEG)])
CALM = {
    "translation_rate_m_s": 0.05,
    "translation_acceleration_m_s2": 0.01,
    "yaw_rate_deg_s": 1.0,
    "yaw_acceleration_deg_s2": 0.5,
}
"""Limits that a vehicle with strong thrusters is far within."""
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def reference_vehicle() -> Vehicle:
    return load_vehicle()


def solver_of(vehicle: Vehicle | None = None, seed: int = 1, **changes) -> StepSolver:
    config = PlannerConfig.model_validate({"method": "genetic_steps", **changes})
    return StepSolver(vehicle or reference_vehicle(), config, seed)


def target_near(solver: StepSolver, configuration, offset, turn=None) -> PathSample:
    """A target `offset` (3,) m from where the tool is, with the orientation `turn` if given."""
    position, _ = tool_pose(solver.model, configuration)
    return PathSample(position + np.asarray(offset, dtype=float), np.zeros(3), turn, None)


def odometry(stamp=0, position=(0.0, 0.0, 10.0), quaternion=LEVEL) -> Odometry:
    return Odometry(
        stamp,
        np.array(position, dtype=float),
        np.array(quaternion, dtype=float),
        np.zeros(6),
        np.zeros((6, 6)),
        np.zeros((6, 6)),
    )


def joints(q_deg=START_DEG, stamp=0) -> JointStates:
    q = np.deg2rad(np.array(q_deg, dtype=float))
    return JointStates(stamp, q, np.zeros_like(q), np.zeros_like(q))


@dataclass
class Drive:
    """A planner driven tick by tick with constant odometry; everything that it gave."""

    planner: MotionPlanner
    q_deg: tuple
    tick: int = -1

    def __post_init__(self):
        self.references, self.steps = [], []
        self.advance()

    def advance(self, ticks: int = 1):
        """That many planner ticks; returns the last step."""
        for _ in range(ticks):
            self.tick += 1
            stamp = to_nanoseconds(0.5 * self.tick)
            step = self.planner.step(stamp, odometry(stamp), joints(self.q_deg, stamp))
            self.references += step.references
            self.steps.append(step)
        return step

    def until_finished(self, limit: int = 4000):
        """Ticks until a goal ends; returns its result."""
        for _ in range(limit):
            step = self.advance()
            if step.finished is not None:
                return step.finished
        raise AssertionError(f"no end after {limit} ticks")

    def joined(self, name: str) -> np.ndarray:
        """A field of all references, one after the other, without the doubled ends."""
        parts = [getattr(r, name)[:-1] for r in self.references[:-1]]
        return np.concatenate([*parts, getattr(self.references[-1], name)])


def drive(vehicle: Vehicle | None = None, q_deg=START_DEG, seed: int = 1, **changes) -> Drive:
    config = PlannerConfig.model_validate(changes)
    return Drive(MotionPlanner(vehicle or reference_vehicle(), config, seed), q_deg)


def assert_smooth(run: Drive):
    """Each reference goes on where the one before ended."""
    for first, second in zip(run.references, run.references[1:], strict=False):
        assert first.end == second.stamp
        for name in ("position", "quaternion", "nu", "nu_dot", "q", "q_dot", "q_ddot"):
            np.testing.assert_allclose(
                getattr(first, name)[-1], getattr(second, name)[0], atol=1e-8, err_msg=name
            )


def assert_within_limits(run: Drive):
    """Rates, within 0.1 %."""
    limits = run.planner._solver.motion_limits
    nu, q_dot = run.joined("nu"), run.joined("q_dot")
    assert np.linalg.norm(nu[:, :2], axis=1).max() <= np.sqrt(2) * limits.rate[0] * 1.001
    assert np.all(np.abs(nu[:, 2]) <= limits.rate[2] * 1.001)
    assert np.all(np.abs(nu[:, 5]) <= limits.rate[3] * 1.001)
    assert np.all(np.abs(q_dot) <= limits.rate[4:] * 1.001)


def short_figure_9(seconds: float = 20.0, scale: float = 0.3) -> PathSpec:
    """The manipulation of Fig. 9, smaller and faster."""
    down, up, bulge = 0.35 * scale, 0.15 * scale, 0.1 * scale
    return PathSpec(
        phases=(
            PathPhase(duration_s=seconds, to_m=(0.0, 0.0, down)),
            PathPhase(duration_s=seconds, to_m=(0.0, 0.0, up), bulge_m=(bulge, 0.0, 0.0)),
            PathPhase(duration_s=seconds, to_m=(0.0, 0.0, 0.0), bulge_m=(0.0, bulge, 0.0)),
        ),
        point_every_s=0.5,
    )


def six_joint_vehicle() -> Vehicle:
    """The reference vehicle with a wrist of three axes."""
    data = _written_out()
    arm = data["arm"]
    wrist, gripper = arm["joints"][3], arm["links"][3]
    wrist.update(alpha_deg=90.0)
    for name, alpha, length in (("bend", -90.0, 0.0), ("spin", 0.0, 0.1)):
        arm["joints"].append({**wrist, "name": name, "alpha_deg": alpha, "d_m": length})
        arm["links"].append({**gripper, "name": f"{name}_link"})
    arm["stowed_deg"], arm["postures_deg"] = [*arm["stowed_deg"], 0.0, 0.0], {}
    return vehicle_from_data(data)


def stubby_vehicle() -> Vehicle:
    """Another vehicle: short, thick, heavier at the keel, the arm at port and lower."""
    data = _written_out()
    data["hull"]["cg_m"][2] = 0.05
    data["hull"]["mass_kg"] += 5.0
    data["arm"]["base"]["position_m"] = [0.4, -0.2, 0.3]
    data["arm"]["joints"][1]["a_m"] = 0.6
    return vehicle_from_data(data)


def _written_out() -> dict:
    """The reference vehicle with every word replaced by its value, as plain data."""
    return yaml.safe_load(dump_vehicle(reference_vehicle()))
