"""Functions that only compiled code calls.

For each compiled function numba also makes a wrapper that takes Python objects apart, which costs
as much as a small kernel, and it compiles the function again for every literal int in a call. A
part has no such wrapper and one code for a type; called from Python it runs as plain Python.
"""

from collections.abc import Callable
from typing import Any

import numba
from numba import extending
from numba.core import types
from numba.core.registry import CPUDispatcher

intrinsic: Any = extending.intrinsic
"""For functions that write LLVM's instructions themselves; numba fills in their first argument."""


class _Part(CPUDispatcher):
    """A dispatcher for calls from compiled code."""

    def __call__(self, *args: Any, **keywords: Any) -> Any:
        return self.py_func(*args, **keywords)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """The typing of a call; a literal counts as a number of its type."""
        plain = {name: types.unliteral(each) for name, each in kws.items()}
        return super().get_call_template(tuple(map(types.unliteral, args)), plain)


def part(**options: Any) -> Callable[[Callable], Any]:
    """A decorator like `numba.njit(**options)` for functions that only compiled code calls."""

    def decorate(function: Callable) -> Any:
        settings: Any = numba.config  # they come from the environment, unknown to mypy
        if settings.DISABLE_JIT:
            return function
        flags = {"nopython": True, "boundscheck": None, "no_cpython_wrapper": True, **options}
        return _Part(py_func=function, targetoptions=flags)

    return decorate
