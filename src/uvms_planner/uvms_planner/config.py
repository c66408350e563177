"""Every parameter of the motion planner, once, with unit, bound and meaning."""

from typing import ClassVar

from pydantic import Field

from uvms_core import registry
from uvms_core.config import Config
from uvms_core.plugin import PluginConfig, Slot
from uvms_core.scene import Obstacles
from uvms_planner.clearance import ClearanceConfig
from uvms_planner.interfaces import StepMethod

FASTEST_M_S = 2.0
"""m/s; beyond it a path is a transit of the vehicle and no work of its arm."""
FASTEST_TURN_DEG_S = 45.0
"""deg/s, and deg/s^2: a vehicle that turns faster throws its arm about."""


class LimitsConfig(Config):
    """Limits of the planned motion. Where one is not given it follows from the vehicle file."""

    translation_rate_m_s: float | None = Field(
        None,
        gt=0,
        le=FASTEST_M_S,
        description="m/s, planned speed of the vehicle along each world axis; none: what half of"
        " its thrust holds against its drag, in the plane along the weaker of surge and sway",
    )
    translation_acceleration_m_s2: float | None = Field(
        None,
        gt=0,
        le=2.0,
        description="m/s^2, planned acceleration of the vehicle along each world axis; none: what a"
        " quarter of its thrust gives its mass and added mass",
    )
    yaw_rate_deg_s: float | None = Field(
        None,
        gt=0,
        le=FASTEST_TURN_DEG_S,
        description="deg/s, planned turning rate of the vehicle; none: by the same rule, and so"
        " that the tool at the arm's full length goes no faster than the vehicle may",
    )
    yaw_acceleration_deg_s2: float | None = Field(
        None,
        gt=0,
        le=FASTEST_TURN_DEG_S,
        description="deg/s^2, planned turning acceleration of the vehicle; none: likewise",
    )
    base_joint_rate_deg_s: float | None = Field(
        None,
        gt=0,
        le=180.0,
        description="deg/s, planned rate of joint 1, which swings the whole arm; none: as of the"
        " other joints",
    )
    joint_rate_fraction: float = Field(
        0.4, gt=0, le=1.0, description="planned joint rate over the vehicle file's limit"
    )
    joint_acceleration_fraction: float = Field(
        0.2, gt=0, le=1.0, description="planned joint acceleration over the vehicle file's limit"
    )
    joint_margin_deg: float = Field(
        2.0, ge=0, le=30.0, description="deg, distance that the plan keeps from each joint limit"
    )
    depth_min_m: float | None = Field(
        None,
        ge=0,
        le=1000.0,
        description="m, least planned depth of the vehicle's origin; none: the radius of a sphere"
        " of the hull's volume, so that it stays under water",
    )
    depth_max_m: float | None = Field(
        None,
        gt=0,
        le=12000.0,
        description="m, greatest planned depth of the vehicle's origin; none: as far above the"
        " vehicle file's seabed, where it has one",
    )
    strict: bool = Field(
        True,
        description="abort the goal where a step is possible only beyond the planned"
        " accelerations; false: take the step, report the limits exceeded, and count it",
    )
    roll_max_deg: float = Field(
        5.0, gt=0, le=90.0, description="deg, roll that the vehicle may take up freely, eq. (17)"
    )
    pitch_max_deg: float = Field(
        4.0, gt=0, le=90.0, description="deg, pitch that the vehicle may take up freely, eq. (17)"
    )


class ProjectionConfig(Config):
    """How a candidate is brought onto the end effector's path."""

    position_tolerance_m: float = Field(
        1e-3, gt=0, le=0.1, description="m, e of eq. (17): candidates farther off are discarded"
    )
    orientation_tolerance_deg: float = Field(
        0.5, gt=0, le=30.0, description="deg, the same for the orientation, where a goal has one"
    )
    iterations: int = Field(8, ge=1, le=100, description="Newton steps at most")
    damping: float = Field(
        1e-3, ge=0, le=1.0, description="damping of the pseudo-inverse, in per-step ranges"
    )
    vehicle_share: float = Field(
        0.5, gt=0, le=1e3, description="how readily the vehicle moves, relative to the joints"
    )


class ManipulabilityConfig(Config):
    """What a posture near a singular one costs a plan over a whole path.

    The measure is Yoshikawa's of the arm, as a share of the best that the arm has.
    """

    weight: float = Field(
        1e-3, ge=0, le=1e3, description="N^2 (or N^2 m^2) for a singular posture; 0: none minds"
    )
    enough: float = Field(
        0.15,
        gt=0,
        le=1.0,
        description="share of the arm's best from which on a posture costs nothing; of an arm of"
        " two links 0.15 is an elbow 9 deg from straight",
    )


class FitnessConfig(Config):
    """What makes a candidate good; combined and with all numbers zero it is eq. (18) as printed."""

    combined: bool = Field(
        False,
        description="judge the sum of restoring and coupling wrench, as printed, not each alone",
    )

    lookahead_s: float = Field(
        6.0, ge=0, le=60.0, description="s, how far ahead the restoring wrench is judged"
    )
    full_rate_m_s: float = Field(
        0.05, gt=0, le=FASTEST_M_S, description="m/s, speed of the vehicle that costs its weight"
    )
    full_acceleration_m_s2: float = Field(
        0.01, gt=0, le=2.0, description="m/s^2, acceleration of the vehicle that costs its weight"
    )
    full_yaw_rate_deg_s: float = Field(
        1.0, gt=0, le=FASTEST_TURN_DEG_S, description="deg/s, turning rate that costs its weight"
    )
    full_yaw_acceleration_deg_s2: float = Field(
        0.5,
        gt=0,
        le=FASTEST_TURN_DEG_S,
        description="deg/s^2, turning acceleration that costs its weight",
    )
    full_base_joint_rate_deg_s: float = Field(
        4.0,
        gt=0,
        le=180.0,
        description="deg/s, rate of joint 1 that costs its weight, 2 deg a step of 0.5 s, unless"
        " its planned limit is lower; of other joints it is the planned limit",
    )
    smoothness_weight: float = Field(
        1.0, ge=0, description="N^2 (or N^2 m^2) for a change of rate at the full acceleration"
    )
    vehicle_motion_weight: float = Field(
        0.2, ge=0, description="N^2 (or N^2 m^2) for the vehicle moving at the full rate"
    )
    joint_motion_weight: float = Field(
        0.02, ge=0, description="N^2 (or N^2 m^2) for a joint moving at the full rate"
    )


class GeneticConfig(Config):
    """The genetic algorithm."""

    population: int = Field(40, ge=8, le=10000, description="individuals of a generation")
    generations: int = Field(15, ge=1, le=10000, description="generations of a step")
    bits_per_variable: int = Field(
        16, ge=2, le=52, description="bits of each gene (the paper: 1000 for the whole chromosome)"
    )
    crossover_rate: float = Field(0.8, ge=0, le=1, description="share of pairs that cross over")
    mutation_rate: float = Field(0.02, ge=0, le=1, description="probability that a bit flips")
    elite: int = Field(2, ge=1, le=8, description="best individuals that are kept unchanged")
    seed_refinements: int = Field(
        1, ge=0, le=50, description="Gauss-Newton steps that improve each seed at the beginning"
    )
    refinements: int = Field(
        3, ge=0, le=50, description="Gauss-Newton steps that polish the best individual"
    )


class PaperConfig(Config):
    """The genetic algorithm as printed, Fig. 3; the paper gives the bits and no other number."""

    bits: int = Field(
        1000, ge=64, le=10000, description="length of the chromosome, all genes together (paper)"
    )
    population: int = Field(
        100, ge=4, le=10000, description="individuals of a generation (our choice; none printed)"
    )
    generations: int = Field(
        100, ge=1, le=10000, description="generations of a step at most (our choice; none printed)"
    )
    patience: int = Field(
        30,
        ge=1,
        le=10000,
        description="generations without a better result that end the search (our choice;"
        " the paper: until no better result is generated)",
    )
    crossover_rate: float = Field(
        0.8, ge=0, le=1, description="share of pairs that cross over (our choice; none printed)"
    )
    mutation_rate: float = Field(
        0.001,
        ge=0,
        le=1,
        description="probability that a bit flips: one bit of a chromosome (our choice; none"
        " printed)",
    )


class SqpConfig(Config):
    """Sequential quadratic programming."""

    iterations: int = Field(30, ge=1, le=1000, description="quadratic programs of a step at most")
    tolerance: float = Field(
        1e-6, gt=0, le=1e-2, description="step that ends the search, of a variable's full rate"
    )


class PlannerConfig(PluginConfig):
    """The motion planner."""

    slot: ClassVar[Slot] = Slot(registry.PLANNERS, "method", StepMethod)

    method: str = Field(
        "genetic",
        description="how paths are planned: genetic (the whole path before it begins); or step by"
        " step: genetic_steps (the paper's, improved), paper (as printed), sqp (sequential"
        " quadratic programming), least_norm (weighted pseudo-inverse), arm_only, vehicle_only (the"
        " arm keeps its posture); that of an installed package, or a class as"
        " my_package.my_module:MyMethod",
    )
    step_s: float = Field(0.5, gt=0, le=10.0, description="s, one planner step")
    sample_s: float = Field(0.05, gt=0, le=1.0, description="s, spacing of the reference's samples")
    start_tolerance_m: float = Field(
        0.1, gt=0, le=1.0, description="m, a path may begin this far from the end effector"
    )
    start_tolerance_deg: float = Field(
        20.0, gt=0, le=180.0, description="deg, the same for the first orientation"
    )
    approach_s: float = Field(
        10.0,
        gt=0,
        le=600.0,
        description="s, in which the tool joins a path that starts at an offset from it",
    )
    limits: LimitsConfig = Field(LimitsConfig(), description="limits of the planned motion")
    clearance: ClearanceConfig = Field(
        ClearanceConfig(), description="distances that the plan keeps"
    )
    obstacles: Obstacles = Field(
        (), description="what the planner knows of; in a scenario its `obstacles` unless given"
    )
    projection: ProjectionConfig = Field(
        ProjectionConfig(), description="precision, eq. (12), (17)"
    )
    manipulability: ManipulabilityConfig = Field(
        ManipulabilityConfig(), description="postures near singular ones, method genetic"
    )
    fitness: FitnessConfig = Field(FitnessConfig(), description="fitness, eq. (18)")
    genetic: GeneticConfig = Field(GeneticConfig(), description="genetic algorithm, Fig. 3")
    paper: PaperConfig = Field(PaperConfig(), description="the same as printed, method paper")
    sqp: SqpConfig = Field(SqpConfig(), description="method sqp")
