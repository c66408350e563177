"""What the paper says about its figures, and what has to be true here for that to hold.

The limits are the paper's where it gives a number, else ours, and generous.
"""

from dataclasses import dataclass

from uvms_bringup.campaign.bound import Bound
from uvms_bringup.paper_figures.numbers import Numbers


@dataclass(frozen=True)
class Claim:
    """A statement of the paper in our words, and the number that answers it."""

    says: str
    key: str  # of the numbers
    unit: str
    bound: Bound
    what: str
    unless: str = ""  # why it does not hold, said where it does not

    def holds(self, numbers: Numbers) -> bool:
        """Whether the number keeps the bound."""
        return not self.bound.fault(self.key, numbers[self.key])


def _at_most(value: float) -> Bound:
    return Bound(max=value)


def _at_least(value: float) -> Bound:
    return Bound(min=value)


FIG6 = (
    Claim(
        "the arm's added mass depends on the elbow's angle",
        "fig6.swing_ratio",
        "",
        _at_most(0.9),
        "about the swing axis, bent by 135° over stretched",
    ),
    Claim("", "fig6.shoulder_ratio", "", _at_most(0.9), "the same about the shoulder axis"),
)
FIG7 = (
    Claim(
        "left alone, the vehicle rolls and pitches violently",
        "fig7.roll_max_deg",
        "°",
        _at_least(10.0),
        "greatest roll",
    ),
    Claim("", "fig7.pitch_max_deg", "°", _at_least(10.0), "greatest pitch"),
    Claim(
        "the restoring forces do it",
        "fig7.restoring_over_coupling",
        "",
        _at_least(1.0),
        "restoring over coupling moment, rms",
    ),
)
FIG8 = (
    Claim(
        "with the observer the attitude is steadier than without",
        "fig8.roll_with_deg",
        "°",
        _at_most(5.0),
        "greatest roll with the observer; limit of (17)",
    ),
    Claim("", "fig8.pitch_with_deg", "°", _at_most(4.0), "the same for pitch"),
    Claim(
        "",
        "fig8.roll_left",
        "",
        _at_most(1.0),
        "greatest roll with over without the observer",
    ),
    Claim("", "fig8.pitch_left", "", _at_most(1.0), "the same for pitch"),
    Claim(
        "the restoring disturbance is 10 to 15",
        "fig8.restoring_max_nm",
        "N m",
        Bound(min=10.0, max=15.0),
        "greatest restoring moment (the axis of the figure has N m)",
    ),
    Claim(
        "restoring outweighs coupling, as the joints are slow",
        "fig8.restoring_over_coupling",
        "",
        _at_least(1.0),
        "restoring over coupling moment, rms",
    ),
    Claim(
        "thrusters need their full power against it",
        "fig8.thrust_share",
        "",
        _at_least(1.0),
        "greatest thrust over the thruster's limit",
        "The vertical thrusters of the reference vehicle keep a reserve: their 49 N are the"
        " paper's, but where they sit, and the arm's weight, are ours.",
    ),
)
FIG9 = (
    Claim(
        "300 s down",
        "fig9.down_m",
        "m",
        Bound(min=0.34, max=0.36),
        "the tool goes down by (asked for: 0.35)",
    ),
    Claim("", "fig9.down_sideways_mm", "mm", _at_most(20.0), "farthest from the vertical"),
    Claim("300 s up in the XOZ plane", "fig9.up_xoz_m", "m", _at_least(0.19), "up by (0.20)"),
    Claim("", "fig9.off_xoz_mm", "mm", _at_most(20.0), "farthest from the plane"),
    Claim("300 s up in the YOZ plane", "fig9.up_yoz_m", "m", _at_least(0.14), "up by (0.15)"),
    Claim("", "fig9.off_yoz_mm", "mm", _at_most(20.0), "farthest from the plane"),
    Claim(
        "and back to the start",
        "fig9.return_mm",
        "mm",
        _at_most(10.0),
        "from the start at the end",
    ),
    Claim(
        "the desired path is followed smoothly",
        "fig9.tracking_rms_mm",
        "mm",
        _at_most(5.0),
        "tool off its path, rms",
    ),
    Claim(
        "the attitude stays small",
        "fig9.roll_max_deg",
        "°",
        _at_most(5.0),
        "greatest roll; limit of (17)",
    ),
    Claim("", "fig9.pitch_max_deg", "°", _at_most(4.0), "greatest pitch; limit of (17)"),
    Claim(
        "moving the vehicle along lessens the disturbance much",
        "fig9.left_of_arm_only",
        "",
        _at_most(0.5),
        "restoring moment, rms, over that of the arm alone on the same path",
    ),
    Claim(
        "coupling makes up most of the forces",
        "fig9.coupling_less_restoring_n",
        "N",
        _at_least(0.0),
        "coupling less restoring force, rms; ours is neutral, so nothing is restored",
    ),
    Claim(
        "restoring makes up most of the moments",
        "fig9.restoring_over_coupling",
        "",
        _at_least(1.0),
        "restoring over coupling moment, rms",
        "The planner leaves so little of the restoring moment that the noise in the coupling"
        " moment outweighs it.",
    ),
    Claim(
        "",
        "fig9.restoring_over_coupling_alone",
        "",
        _at_least(1.0),
        "the same where the arm moves alone, and nothing lessens it",
    ),
    Claim(
        "the base joint turns by 1-2° a step of 0.5 s",
        "fig9.swing_step_deg",
        "°",
        Bound(min=1.0, max=2.0),
        "greatest turn of the swing joint in a step",
        "After some 80 s the arm stays in the posture whose restoring moment is least, and the"
        " vehicle carries the tool.",
    ),
)
