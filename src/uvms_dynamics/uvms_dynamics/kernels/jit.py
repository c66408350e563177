"""How kernels are compiled: cached on disk, IEEE arithmetic, no hidden checks.

`contract` lets the compiler round a product and the sum that follows it once instead of twice; the
exact ones round every operation, as numpy does. No function pointers for C are made, and the sets
of options are few: numba compiles its own functions anew for each of them.
"""

from collections.abc import Callable
from typing import Any

from numba import njit

from uvms_dynamics.kernels.numba_internals.parts import part

_EXACT: Any = {"error_model": "numpy", "no_cfunc_wrapper": True}
_CONTRACTED: Any = {**_EXACT, "fastmath": {"contract"}}
OPTIONS: Any = {**_CONTRACTED, "forceinline": True}

_names: set[tuple[str, str]] = set()


def _kernel(options: Any) -> Callable[[Callable], Any]:
    def decorate(function: Callable) -> Any:
        _names.add((function.__module__, function.__qualname__))
        return njit(cache=True, **options)(function)

    return decorate


kernel = _kernel(_CONTRACTED)
"""For functions that are called from Python or from several kernels."""

inner = part(**OPTIONS)
"""For parts of a kernel: always inlined, or each call would copy every table of the model."""

shared = part(**_CONTRACTED)
"""For parts that several places of a kernel call: the compiler chooses what to inline."""

exact_kernel = _kernel(_EXACT)
"""For functions that are called from Python and round every operation."""

exact_inner = part(**_EXACT)
"""For parts of such a kernel; the compiler chooses what to inline."""


def kernel_names() -> frozenset[tuple[str, str]]:
    """(module, name) of the kernels of all modules that have been imported."""
    return frozenset(_names)
