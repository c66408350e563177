"""Design of the vehicle's loop: stability margins, the largest bandwidth that keeps them."""

from uvms_control.design.axis import Axis, AxisGains
from uvms_control.design.bandwidth import AxisDesign, Limits, largest_bandwidth
from uvms_control.design.margins import Margins, loop_margins
from uvms_control.design.vehicle_axes import Timing, axis_thrust, vehicle_axes
from uvms_dynamics.sensor_noise import sensor_noise

__all__ = [
    "Axis",
    "AxisDesign",
    "AxisGains",
    "Limits",
    "Margins",
    "Timing",
    "axis_thrust",
    "largest_bandwidth",
    "loop_margins",
    "sensor_noise",
    "vehicle_axes",
]
