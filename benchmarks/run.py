"""Measure speed and quality of UVMS: one JSON object per line on standard output.

Keys: name, value, unit, reference (what it is compared with, in words), ratio, target, met.
`ratio` is our value over the reference's, in the same unit: lower is better for times and errors,
higher for rates. For speed both take turns in one process. A missed target is `"met": false`; the
exit code is still 0, so that no measurement is lost.
"""

import argparse
import os
import sys
import time
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType

# One core for each side of a comparison: keeps BLAS libraries from starting threads.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

CASES = tuple(
    path.stem for path in sorted((Path(__file__).parent / "cases").glob("[!_]*.py"))
)  # one benchmark per file: `measure(full)` yields its metrics


def main() -> int:
    """Run the benchmarks asked for, all of them by default."""
    options = parser().parse_args()
    unknown = sorted(set(options.names) - set(CASES))
    if unknown:
        print(f"unknown: {', '.join(unknown)}; choose from {', '.join(CASES)}", file=sys.stderr)
        return 2
    if options.list:
        for name in CASES:
            print(f"{name:18s} {_summary(case(name))}")
        return 0
    began = time.perf_counter()
    failed = [name for name in options.names or CASES if not _run(name, options.full)]
    log(f"{time.perf_counter() - began:.0f} s in total")
    if failed:
        log(f"could not be measured: {', '.join(failed)}")
    return 1 if failed else 0


def parser() -> argparse.ArgumentParser:
    """The command line."""
    made = argparse.ArgumentParser(
        prog="benchmarks/run.py",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument("names", nargs="*", metavar="NAME", help=f"any of: {', '.join(CASES)}")
    made.add_argument("--list", action="store_true", help="list what each benchmark measures")
    made.add_argument("--full", action="store_true", help="whole runs instead of shortened ones")
    return made


def case(name: str) -> ModuleType:
    """The module of a benchmark."""
    return import_module(f"cases.{name}")


def log(text: str) -> None:
    """Progress, on standard error."""
    print(f"# {text}", file=sys.stderr, flush=True)


def _summary(module: ModuleType) -> str:
    return (module.__doc__ or "").strip().splitlines()[0]


def _run(name: str, full: bool) -> bool:
    """Print a benchmark's metrics; False if it failed, which does not stop the others."""
    began = time.perf_counter()
    try:
        module = case(name)
        log(f"{name}: {_summary(module)}")
        metrics: Iterator = module.measure(full)
        for metric in metrics:
            print(metric.line(), flush=True)
    except Exception as fault:  # the others are measured all the same
        log(f"{name} failed: {type(fault).__name__}: {fault}")
        return False
    log(f"{name}: {time.perf_counter() - began:.1f} s")
    return True


if __name__ == "__main__":
    raise SystemExit(main())
