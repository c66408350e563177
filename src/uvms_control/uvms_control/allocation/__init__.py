"""Thrust allocation: one wrench to bounded thrusts."""

from uvms_control.allocation.allocator import ThrustAllocator, WeightedAllocator
from uvms_control.allocation.authority import (
    axes_pushed_one_way,
    axes_without_authority,
    axis_authority,
)
from uvms_control.allocation.box_qp import solve_box_qp
from uvms_control.allocation.least_squares import BoundedLeastSquares
from uvms_control.allocation.levels import solve_levels
from uvms_control.allocation.lexicographic import LexicographicLeastSquares

__all__ = [
    "BoundedLeastSquares",
    "LexicographicLeastSquares",
    "ThrustAllocator",
    "WeightedAllocator",
    "axes_pushed_one_way",
    "axes_without_authority",
    "axis_authority",
    "solve_box_qp",
    "solve_levels",
]
