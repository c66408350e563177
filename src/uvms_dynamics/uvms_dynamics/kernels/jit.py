"""How kernels are compiled: cached on disk, IEEE arithmetic, no hidden checks.

`contract` lets the compiler round a product and the sum that follows it once instead of twice.
"""

from typing import Any

from numba import extending, njit

_ARITHMETIC: Any = {"error_model": "numpy", "fastmath": {"contract"}}
OPTIONS: Any = {**_ARITHMETIC, "forceinline": True}

kernel = njit(cache=True, **_ARITHMETIC)
"""For functions that are called from Python or from other modules' kernels."""

inner = njit(cache=True, **OPTIONS)
"""For parts of a kernel: always inlined, or each call would copy every table of the model."""

intrinsic: Any = extending.intrinsic
"""For functions that write LLVM's instructions themselves; numba fills in their first argument."""
