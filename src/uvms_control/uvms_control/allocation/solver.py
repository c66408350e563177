"""What the allocator asks of a solver of its problem without gaps."""

from typing import Any, NoReturn, Protocol

from uvms_core.signals import Array


class Solver(Protocol):
    """Thrusts within bounds for one layout of thrusters."""

    limits: Array
    """(m,) N by which thrusts are compared."""
    max_steps: int
    """Steps after which the solver gives up."""

    @property
    def tables(self) -> tuple[Array, Array, Array]:
        """Matrix (6, m), scale of the axes' errors (6,) and limits (m,) N."""
        ...

    def solve(self, tau: Array, lower: Array, upper: Array) -> Array:
        """Thrusts (m,) N for the wrench `tau` (6,) within bounds (m,) N."""
        ...

    def problem(self, tau: Array) -> tuple[Any, Any]:
        """The problem for a wrench as the kernels take it: weighted or None, levels or None."""
        ...

    def fail(self, tau: Array) -> NoReturn:
        """Raise AllocationError: no thrust was found for this wrench (6,)."""
        ...

    def reset(self) -> None:
        """Forget the warm start."""
        ...
