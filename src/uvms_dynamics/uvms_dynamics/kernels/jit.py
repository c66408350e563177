"""How kernels are compiled: cached on disk, IEEE arithmetic, no hidden checks."""

from numba import njit

kernel = njit(cache=True, error_model="numpy", fastmath={"contract"})
"""For functions that are called from Python or from other modules' kernels."""

inner = njit(cache=True, error_model="numpy", fastmath={"contract"}, forceinline=True)
"""For parts of a kernel: always inlined, or each call would copy every table of the model."""
