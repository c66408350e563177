"""The only code that rests on numba's internals, which may change with any of its versions.

`parts` subclasses numba's dispatcher, compiler and code library; `lanes` defines a type with its
data model, typing, casts and lowering; `primitives` and `lanes` write LLVM instructions with
llvmlite; `compilations` listens to numba's events. What they use: `numba.extending`, of
`numba.core` `cgutils`, `codegen.JITCodeLibrary`, `compiler.Compiler`, `datamodel`, `event`,
`imputils`, `registry.CPUDispatcher`, `typeconv`, `types` and `typing.templates`; `llvmlite.ir`.
No other module of the project imports `numba.core` or llvmlite.

Tried with numba 0.68.1 and llvmlite 0.50.0. Before SUPPORTED and the bounds in setup.py are
widened, run the tests of uvms_dynamics with the new version, test_arithmetic above all.
"""

import numba

SUPPORTED = (0, 61), (0, 69)
"""Versions of numba (major, minor): from the first, below the second, as in setup.py."""


def check_version(version: tuple[int, int]) -> None:
    """Raise ImportError unless the kernels are known to compile with this version of numba."""
    least, beyond = SUPPORTED
    if not least <= version < beyond:
        raise ImportError(
            f"numba {_text(version)} is installed; the kernels of uvms_dynamics need"
            f" >= {_text(least)}, < {_text(beyond)}: pip install"
            f" 'numba>={_text(least)},<{_text(beyond)}'"
        )


def _text(version: tuple[int, int]) -> str:
    return ".".join(map(str, version))


check_version(numba.version_info[:2])
