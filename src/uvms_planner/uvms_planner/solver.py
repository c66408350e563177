"""From one knot to the next: the strategies that choose an increment, on one footing.

`genetic` is the paper's. `least_norm` (weighted pseudo-inverse, the smallest motion that follows
the path) and `arm_only` (the same with the vehicle held still) are what it is compared with.
All share the projection, the limits and the judgement.
"""

from dataclasses import dataclass

import numpy as np

from uvms_core.end_effector_path import PathSample
from uvms_core.rng import generator
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model, build_model
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_planner.config import PlannerConfig
from uvms_planner.constraints import free_attitude
from uvms_planner.fitness import judge, self_disturbance
from uvms_planner.genetic import GeneticSettings, evolve
from uvms_planner.limits import JointLimits, StepLimits, frozen
from uvms_planner.problem import VEHICLE, StepProblem
from uvms_planner.projection import project


@dataclass(frozen=True)
class Choice:
    """What a strategy chose for one step, and how good it is."""

    valid: bool  # whether the end effector is within e of the path
    increment: Array  # (m,)
    distance: float  # m, of the end effector from the path
    angle: float  # rad, the same for the orientation; 0 without one
    attitude_violation: float  # rad beyond the limits of eq. (17)
    cost: float  # 1 / fitness, eq. (18) with the motion's costs
    evaluations: int
    feasible: int  # candidates within e and the attitude limits
    discarded: int  # candidates not within e


class StepSolver:
    """Chooses the increment of the configuration for each step by `config.method`."""

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int):
        self.model: Model = build_model(vehicle)
        self.joints = JointLimits.of(vehicle)
        self.limits = StepLimits.of(self.joints, config.limits, config.step_s)
        self._config = config
        self._seed = seed
        self._settings = _settings(config)
        self._readiness, self._motion_weights = _weights(self.limits, config)

    @property
    def size(self) -> int:
        """M = 4 + n, the length of the configuration."""
        return len(self.limits.reach)

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
        config = self._config
        lower, upper = bounds or self.limits.increments(configuration, previous)
        if config.method == "arm_only":
            lower, upper = frozen((lower, upper))
        oriented = target.quaternion is not None
        return StepProblem(
            configuration=configuration.copy(),
            previous=previous.copy(),
            lower=lower,
            upper=upper,
            reach=self.limits.reach,
            jump=self.limits.jump,
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
            roll_max=np.deg2rad(config.limits.roll_max_deg),
            pitch_max=np.deg2rad(config.limits.pitch_max_deg),
        )

    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The increment of step number `index`; the same for the same seed and index.

        Where nothing within the accelerations is on the path, the rates alone bound the step.
        """
        choice = self._choose(problem, index)
        if choice.valid:
            return choice
        bounds = self.limits.rate_increments(problem.configuration)
        if self._config.method == "arm_only":
            bounds = frozen(bounds)
        return self._choose(problem._replace(lower=bounds[0], upper=bounds[1]), index)

    def _choose(self, problem: StepProblem, index: int) -> Choice:
        if self._config.method == "genetic":
            return self._evolved(problem, index)
        return self._least_norm(problem)

    def _evolved(self, problem: StepProblem, index: int) -> Choice:
        previous = problem.previous
        seeds = np.array([previous, np.zeros_like(previous), 0.5 * previous])
        rng = generator(self._seed, f"planner step {index}")
        found, increment, violation, cost, discarded, feasible, evaluations = evolve(
            self.model, problem, self._settings, seeds, rng
        )
        if not found:
            return self._least_norm(problem)
        distance, angle = project(self.model, problem, increment)
        return Choice(
            found, increment, distance, angle, violation, cost, evaluations, feasible, discarded
        )

    def _least_norm(self, problem: StepProblem) -> Choice:
        increment = np.zeros(self.size)
        valid, violation, cost = judge(self.model, problem, increment)
        distance, angle = project(self.model, problem, increment)
        feasible = int(valid and violation == 0.0)
        return Choice(
            valid, increment, distance, angle, violation, cost, 1, feasible, int(not valid)
        )

    def disturbance(self, problem: StepProblem, increment: Array) -> Array:
        """F_dis (6,) of eq. (16) at the end of the step, without looking ahead."""
        wrenches = self_disturbance(self.model, problem, increment, 0.0)
        return wrenches[:6] + wrenches[6:]

    def free_attitude(self, configuration: Array) -> tuple[float, float]:
        """Roll and pitch in rad that the vehicle takes up freely in `configuration` (m,)."""
        return free_attitude(self.model, configuration[VEHICLE:].copy())


def _settings(config: PlannerConfig) -> GeneticSettings:
    genetic = config.genetic
    return GeneticSettings(
        population=genetic.population,
        generations=genetic.generations,
        bits=genetic.bits_per_variable,
        crossover_rate=genetic.crossover_rate,
        mutation_rate=genetic.mutation_rate,
        elite=genetic.elite,
        seed_refinements=genetic.seed_refinements,
        refinements=genetic.refinements,
    )


def _weights(limits: StepLimits, config: PlannerConfig) -> tuple[Array, Array]:
    """Readiness of the projection and motion weights of the fitness, both (m,)."""
    readiness = limits.reach**2
    readiness[:VEHICLE] *= config.projection.vehicle_share**2
    if config.method == "arm_only":
        readiness[:VEHICLE] = 0.0
    motion = np.full(len(limits.reach), config.fitness.joint_motion_weight)
    motion[:VEHICLE] = config.fitness.vehicle_motion_weight
    return readiness, motion
