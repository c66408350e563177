"""Functions that only compiled code calls.

For each compiled function numba also makes a wrapper that takes Python objects apart, which costs
as much as a small kernel; it makes machine code of the function by itself, though its callers
inline it; and it compiles it again for every literal int in a call. A part has none of this.
Called from Python it runs as plain Python.

Its code is optimized before it is linked into that of a caller. Without that it compiles in less
time still, but the compiler then rounds other products and sums at once.
"""

from collections.abc import Callable
from typing import Any

import numba
from numba import extending
from numba.core import types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher

intrinsic: Any = extending.intrinsic
"""For functions that write LLVM's instructions themselves; numba fills in their first argument."""


class _LinkedLibrary(JITCodeLibrary):
    """Code for linking into that of callers; there is no machine code of it."""

    @property
    def codegen(self) -> "_LinkedLibrary":
        """What is asked to set the function's environment."""
        return self

    def set_env(self, _name: str, _environment: Any) -> None:
        """Nothing: only code of its own would have one."""

    def get_pointer_to_function(self, _name: str) -> int:
        """No address."""
        self._ensure_finalized()
        return 0

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class _PartCompiler(Compiler):
    """numba's compiler, but for the library that the code goes to."""

    def compile_extra(self, func: Callable) -> Any:
        """Compile a function."""
        self.state.library = _LinkedLibrary(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


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
        return _Part(py_func=function, targetoptions=flags, pipeline_class=_PartCompiler)

    return decorate
