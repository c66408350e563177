"""The questions around which the report is built, each with its figures and its plots."""

from dataclasses import dataclass

from uvms_analysis.report import metrics
from uvms_analysis.report.metrics import Metric
from uvms_analysis.report.plot import Group
from uvms_analysis.report.plots import (
    attitude,
    disturbance,
    effort,
    energy,
    health,
    stability,
    tracking,
)


@dataclass(frozen=True)
class Question:
    """A section of the page."""

    key: str
    title: str
    intro: str
    metrics: tuple[Metric, ...]
    groups: tuple[Group, ...]


QUESTIONS = (
    Question(
        "how-well",
        "How well did it work?",
        "What counts for the control is the error that the loop can see; the true error has that"
        " of navigation on top.",
        metrics.HOW_WELL,
        (
            Group("tool-error", "Tool against its target",
                  "Distance of the end effector from where it should be, and its parts along north,"
                  " east and down.", tracking.tool_error),
            Group("attitude", "Attitude", "Roll, pitch and yaw of the vehicle.",
                  attitude.attitude),
            Group("vehicle-error", "Vehicle against its reference",
                  "Distance of the vehicle from where the plan wants it.",
                  tracking.vehicle_error),
            Group("navigation", "Navigation against the truth",
                  "Estimated less true position with three of the filter's own standard"
                  " deviations, and attitude.", health.navigation),
            Group("joints", "Joints", "Joint angles, and how far they are off their plan.",
                  tracking.joints),
            Group("clearance", "Clearance",
                  "Distances of bodies that must not touch; those that come closest.",
                  attitude.clearance),
            Group("tool-position", "Where the tool is", "End effector and its target.",
                  tracking.tool_position, is_open=False),
            Group("vehicle-position", "Where the vehicle is", "Vehicle and its reference.",
                  attitude.position, is_open=False),
        ),
    ),
    Question(
        "disturbed",
        "What disturbed it?",
        "The self-disturbance is what weight and buoyancy of vehicle and arm (restoring) and the"
        " arm's reaction (coupling) do to the vehicle; what is left is external. Body frame, about"
        " its origin.",
        metrics.DISTURBED,
        (
            Group("budget", "Budget",
                  "Sizes of the parts of the disturbance. Peaks outside of a plot are named in"
                  " it.", disturbance.budget),
            Group("plan", "Plan against truth",
                  "Self-disturbance as planned, as it was and as it was observed.",
                  disturbance.plan_against_truth),
            Group("external", "External disturbance",
                  "What the observer attributes to the world, with three standard deviations where"
                  " it knows them.", disturbance.external, is_open=False),
        ),
    ),
    Question(
        "cost",
        "What did it cost?",
        "Electrical energy is what the vehicle file says that thrusts, torques and the hotel load"
        " take. Work is mechanical; what is braked counts as well.",
        metrics.COST,
        (
            Group("authority", "Authority left",
                  "Share of its limit that the busiest thruster still has, and all thrust.",
                  effort.authority),
            Group("thrusters", "Thrusters", "Thrust as allocated, and as the plant gave it.",
                  effort.thrusters),
            Group("wrench", "Wrench on the vehicle",
                  "What the controller commands and what the thrusters achieve by the allocator's"
                  " account. The first ticks may hold steps.", effort.wrench),
            Group("torques", "Joint torques", "As commanded and as measured.", effort.torques),
            Group("electrical", "Electrical power",
                  "By the true thrusts, torques and rates.", energy.electrical),
            Group("battery", "Battery", "As battery_state says.", energy.battery),
            Group("power", "Mechanical power", "Negative: braked.", effort.power, is_open=False),
        ),
    ),
    Question(
        "healthy",
        "How healthy was it?",
        "",
        metrics.HEALTH,
        (
            Group("consistency", "Is navigation as good as it says?",
                  "A filter that knows its errors has a squared error of one covariance per axis,"
                  " and residuals of one (NIS over the dimension).", health.consistency),
            Group("effectiveness", "Thrusters", "As the allocator takes them to be.",
                  health.thruster_health),
            Group("computing", "Computing and commands",
                  "A tick in which the plant had no usable command is a gap.", health.computing),
        ),
    ),
    Question(
        "stable",
        "Was it stable?",
        "By the controller's own account: the Lyapunov function of the vehicle's loop, eq. (27) of"
        " the paper. The condition below eq. (29) is sufficient and not necessary.",
        metrics.STABLE,
        (Group("stability", "V and condition (29)", "V, its rate, and both sides of the"
               " condition.", stability.stability),),
    ),
)  # fmt: skip
