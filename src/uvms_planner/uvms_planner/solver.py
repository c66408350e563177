"""From one knot to the next: sets up the problem of one step and lets the method solve it.

All methods share the projection, the limits and the cost of the problem; what differs is in the
classes of `methods/`.
"""

from dataclasses import replace

import numpy as np

from uvms_core.end_effector_path import PathSample
from uvms_core.plugin import create
from uvms_core.signals import Array, DisturbanceBudget
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model, build_model
from uvms_dynamics.geometry import Geometry, build_geometry, clearances
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.payload import LoadedModel
from uvms_planner.choice import Choice
from uvms_planner.clearance import clearance_margins
from uvms_planner.config import PlannerConfig
from uvms_planner.constraints import free_attitude
from uvms_planner.exceeded import limits_exceeded
from uvms_planner.fitness import self_disturbance
from uvms_planner.interfaces import StepMethod
from uvms_planner.limits import JointLimits, MotionLimits, StepLimits, StepScales
from uvms_planner.motion_tilt import Tilt
from uvms_planner.problem import VEHICLE, StepProblem
from uvms_planner.segment import Knot
from uvms_planner.whole_path import (
    CostWeights,
    PathPlan,
    PathProblem,
    Posture,
    Surroundings,
    ToolPath,
)
from uvms_planner.whole_path.coming_level import level_once_back
from uvms_planner.whole_path.manipulability import best_manipulability, manipulability
from uvms_planner.whole_path.path_problem import Path
from uvms_planner.whole_path.solve import Progress
from uvms_planner.whole_path.surroundings import surroundings

NOTICEABLE = 0.1
"""Change of a thruster's effectiveness from which on it is planned with."""


MORE_TILT = 1.2
"""A vehicle that floats beyond its limits may float so many times farther on its way back."""


CLOSER, CLOSER_M = 0.1, 1e-3
"""Share of a clearance, and m, by which a pair may come closer that is at its margin already."""


class StepSolver:
    """Chooses the increment of the configuration for each step by the method of `config`."""

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int):
        self._loaded = LoadedModel(build_model(vehicle))
        self.joints = JointLimits.of(vehicle)
        self.motion_limits = MotionLimits.of(vehicle, self._loaded.model, config.limits)
        self.limits = StepLimits.of(self.motion_limits, config.step_s)
        self._scales = StepScales.of(vehicle, config)
        self.config = config
        self._vehicle, self._health = vehicle, np.ones(len(vehicle.thrusters))
        self._geometry = build_geometry(vehicle, config.obstacles)
        self._margins = clearance_margins(config.clearance, vehicle, self._geometry)
        self.around = self._surroundings()
        limits = self.motion_limits
        bounds = limits.lower[VEHICLE:], limits.upper[VEHICLE:]
        self._best_manipulability = best_manipulability(self.model, *bounds)
        self.steps_beyond_limits = 0
        self._method: StepMethod = create(config, vehicle, seed)
        self._readiness = self._method.readiness(_readiness(self._scales, config))
        self._motion_weights = _motion_weights(len(self.limits.reach), config)

    @property
    def model(self) -> Model:
        """The vehicle's table, with the payload that is held."""
        return self._loaded.model

    def take(self, budget: DisturbanceBudget) -> bool:
        """Plan from now on with the payload and the thrusters of a budget; True if they are new.

        Thrusters count from a change by `NOTICEABLE` on, as their estimate never rests.
        """
        changed = self._loaded.take(budget.payload)
        health = self._health if budget.thrusters is None else budget.thrusters.effectiveness
        if np.abs(health - self._health).max(initial=0.0) >= NOTICEABLE:
            self._health = np.clip(health, 0.0, 1.0)
            self.around = self._surroundings()
            changed = True
        return changed

    @property
    def geometry(self) -> Geometry:
        """Shapes of the vehicle and of what stands around it."""
        return self._geometry

    def tilt(self) -> Tilt:
        """How far the vehicle would tilt on its way, with the thrusters that it has now."""
        return Tilt(self._vehicle, self._health)

    def _surroundings(self) -> Surroundings:
        return surroundings(self._vehicle, self._geometry, self._margins, health=self._health)

    @property
    def size(self) -> int:
        """M = 4 + n, the length of the configuration."""
        return len(self.limits.reach)

    @property
    def plans_paths(self) -> bool:
        """Whether the method plans whole paths before they begin."""
        return hasattr(self._method, "plan_path")

    def path_problem(self, path: Path, start: Knot) -> PathProblem:
        """A whole path from a knot, with the limits, and with what stands around, as known now."""
        singular = self.config.manipulability
        return PathProblem(
            self.model,
            ToolPath(path),
            path.duration,
            posture_of(start),
            self.limits_from(start.configuration),
            weights=CostWeights(singular=singular.weight, manipulability=singular.enough),
            around=self.around_from(start.configuration),
            turn_tolerance=np.deg2rad(self.config.projection.orientation_tolerance_deg),
        )

    def around_from(self, configuration: Array) -> Surroundings:
        """What a plan from a configuration (m,) must keep clear of.

        Where the start is closer than a margin, or at it, that pair may stay almost as close.
        """
        now = clearances(self._geometry, configuration)
        margins = np.minimum(self.around.margins, now - CLOSER * np.abs(now) - CLOSER_M)
        return self.around._replace(margins=margins)

    def limits_from(self, configuration: Array) -> MotionLimits:
        """The limits of a plan from a configuration (m,).

        Where the vehicle would float beyond the limits of eq. (17) already, it may do so a little
        farther: nothing is gained by pressing it back faster than the cost does.
        """
        tilt, limits = np.abs(self.free_attitude(configuration)), self.motion_limits
        most = np.array([limits.roll_max, limits.pitch_max])
        roll, pitch = np.where(tilt > most, MORE_TILT * tilt, most)
        return replace(limits, roll_max=float(roll), pitch_max=float(pitch))

    def plan_path(self, problem: PathProblem, progress: Progress) -> PathPlan:
        """The method's plan over a whole path; only where `plans_paths`."""
        limits = self.motion_limits
        method = self._method.plan_path  # type: ignore[attr-defined]
        return level_once_back(problem, (limits.roll_max, limits.pitch_max), method, progress)

    def problem(
        self,
        configuration: Array,
        previous: Array,
        target: PathSample,
        bounds: tuple[Array, Array] | None = None,
    ) -> StepProblem:
        """The step from `configuration` (m,), after the increment `previous` (m,), to `target`.

        `bounds` are the least and greatest increment; by default those of all limits.
        """
        config = self.config
        limits = bounds or self.limits.increments(configuration, previous)
        lower, upper = self._method.bounds(*limits)
        oriented = target.quaternion is not None
        return StepProblem(
            configuration=configuration.copy(),
            previous=previous.copy(),
            lower=lower,
            upper=upper,
            reach=self._scales.reach,
            jump=self._scales.jump,
            readiness=self._readiness,
            motion_weights=self._motion_weights,
            position=np.array(target.position, dtype=float),
            rotation=quat_to_matrix(target.quaternion) if oriented else np.eye(3),
            oriented=oriented,
            position_tolerance=config.projection.position_tolerance_m,
            orientation_tolerance=np.deg2rad(config.projection.orientation_tolerance_deg),
            iterations=config.projection.iterations,
            damping=config.projection.damping,
            step=config.step_s,
            lookahead=config.fitness.lookahead_s,
            combined=config.fitness.combined,
            smoothness_weight=config.fitness.smoothness_weight,
            roll_max=self.motion_limits.roll_max,
            pitch_max=self.motion_limits.pitch_max,
        )

    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The increment of step number `index`; the same for the same seed and index.

        Where nothing within the accelerations is on the path, the rates alone bound the step, and
        the choice says what it takes beyond the limits; where they are strict it is not valid.
        """
        choice = self._method.choose(problem, index)
        if choice.valid:
            return choice
        limits = self.limits.rate_increments(problem.configuration)
        lower, upper = self._method.bounds(*limits)
        choice = self._method.choose(problem._replace(lower=lower, upper=upper), index)
        if not choice.valid:
            return choice
        beyond = limits_exceeded(problem, choice.increment, self.joints.names)
        strict = self.config.limits.strict
        self.steps_beyond_limits += not strict
        return replace(choice, valid=not strict, limits_exceeded=beyond)

    def disturbance(self, problem: StepProblem, increment: Array) -> Array:
        """F_dis (6,) of eq. (16) at the end of the step, without looking ahead."""
        wrenches = self_disturbance(self.model, problem, increment, 0.0)
        return wrenches[:6] + wrenches[6:]

    def manipulability(self, configuration: Array) -> float:
        """That of the arm in a configuration (m,), as a share of its best; 0 at a singularity."""
        if self._best_manipulability == 0.0:
            return 0.0
        own = manipulability(self.model, np.array(configuration[None, VEHICLE:]))
        return float(own[0]) / self._best_manipulability

    def attitude_violation(self, configuration: Array) -> float:
        """How far in rad the free attitude lies beyond the limits in `configuration` (m,)."""
        roll, pitch = np.abs(self.free_attitude(configuration))
        limits = self.motion_limits
        return float(max(roll - limits.roll_max, 0.0) + max(pitch - limits.pitch_max, 0.0))

    def free_attitude(self, configuration: Array) -> tuple[float, float]:
        """Roll and pitch in rad that the vehicle takes up freely in `configuration` (m,)."""
        return free_attitude(self.model, configuration[VEHICLE:].copy())


def posture_of(knot: Knot) -> Posture:
    """Yaw and joints of a knot."""
    own = slice(VEHICLE - 1, None)
    return Posture(knot.configuration[own], knot.rate[own], knot.acceleration[own])


def _readiness(scales: StepScales, config: PlannerConfig) -> Array:
    """Inverse weights (m,) of the projection: how ready each variable is to move."""
    readiness = scales.reach**2
    readiness[:VEHICLE] *= config.projection.vehicle_share**2
    return readiness


def _motion_weights(size: int, config: PlannerConfig) -> Array:
    """Costs (m,) of each variable's motion by one reach."""
    weights = np.full(size, config.fitness.joint_motion_weight)
    weights[:VEHICLE] = config.fitness.vehicle_motion_weight
    return weights
