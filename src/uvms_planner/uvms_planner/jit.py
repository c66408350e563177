"""How the planner's kernels are compiled: cached on disk, IEEE arithmetic."""

from numba import njit

kernel = njit(cache=True, error_model="numpy")
"""For functions that are called from Python or from several kernels."""

inner = njit(cache=True, error_model="numpy", forceinline=True)
"""For parts of a kernel: always inlined, or each call would copy every table of the model."""
