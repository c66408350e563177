"""Design of the vehicle's loop: stability margins, the largest bandwidth that keeps them."""

from uvms_control.design.axis import Axis, AxisGains
from uvms_control.design.bandwidth import AxisDesign, Limits, largest_bandwidth
from uvms_control.design.margins import Margins, loop_margins

__all__ = [
    "Axis",
    "AxisDesign",
    "AxisGains",
    "Limits",
    "Margins",
    "largest_bandwidth",
    "loop_margins",
]
