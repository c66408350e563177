"""Thrust allocation: one wrench to bounded thrusts."""

from uvms_control.allocation.allocator import ThrustAllocator
from uvms_control.allocation.authority import (
    axes_pushed_one_way,
    axes_without_authority,
    axis_authority,
)
from uvms_control.allocation.box_qp import solve_box_qp
from uvms_control.allocation.least_squares import BoundedLeastSquares

__all__ = [
    "BoundedLeastSquares",
    "ThrustAllocator",
    "axes_pushed_one_way",
    "axes_without_authority",
    "axis_authority",
    "solve_box_qp",
]
