"""Sets up .venv: Python packages, ROS interfaces, the project itself. Standard library only.

    python3 tools/environment [--development]

Stages whose inputs have not changed since they ended are left alone, so that a second call does
nothing. A set-up that was interrupted begins afresh where its traces could mislead. The variable
PYTHON names the interpreter to use.
"""

import fcntl
import os
import sys
from pathlib import Path

import machine
from commands import Background, Stage
from stages import ENVIRONMENT, FOR_KERNELS, Context, plan
from stamps import kernel_sources

ROOT = Path(__file__).resolve().parents[2]
# Stages that leave half-installed packages behind when they are interrupted.
FRAGILE = ("runtime", "ros", "development", "packages")
KERNELS = "kernels"


def main():
    """Set up what is not yet; return the exit code."""
    development = "--development" in sys.argv[1:]
    explicit = bool(os.environ.get("PYTHON"))
    context = Context(ROOT)
    try:
        if _pending(context, development, explicit):
            _use_supported_python(explicit)
            machine.check()
            _set_up(context, development, explicit)
        elif not context.stamps().done(KERNELS, kernel_sources(context.root)):
            _compile_alone(context)
    except machine.SetupError as fault:
        print("\nThe set-up cannot go on:\n%s" % fault, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nThe set-up was interrupted; the next call goes on with it.", file=sys.stderr)
        return 130
    return 0


def _pending(context, development, explicit):
    """The stages whose inputs have changed since they ended, or that never did."""
    stamps = context.stamps()
    keys = {stage: stage.key(context, explicit) for stage in plan(development)}
    whole = stamps.done(ENVIRONMENT.name, keys[ENVIRONMENT]) and context.python.exists()
    if not whole or stamps.interrupted in FRAGILE:
        return list(keys)
    return [stage for stage, key in keys.items() if not stamps.done(stage.name, key)]


def _use_supported_python(explicit):
    """Go on in a supported Python of the machine, if this one is not and the user named none."""
    other = machine.other_python()
    if not explicit and not machine.supported_python() and other:
        os.execv(other, [other, *sys.argv])


def _set_up(context, development, explicit):
    lock = os.open(str(ROOT), os.O_RDONLY)  # one set-up at a time; released when this program ends
    fcntl.flock(lock, fcntl.LOCK_EX)
    pending = _pending(context, development, explicit)  # again: another call may have done it
    if not pending:
        return
    _carry_out_all([stage for stage in pending if stage in FOR_KERNELS], context, explicit)
    kernels = _compile_kernels(context)  # on one core; the rest of the stages leave one free
    try:
        rest = [stage for stage in pending if stage not in FOR_KERNELS]
        _carry_out_all(rest, context, explicit, kernels)
        _finish(kernels, context)
    except BaseException:
        kernels.stop()
        raise
    print("[set-up] done; the log is %s" % context.log.relative_to(ROOT))


def _carry_out_all(stages, context, explicit, beside=None):
    for stage in stages:
        with Stage(stage.title, context.log, beside) as running:
            _carry_out(stage, running, context, explicit)


def _carry_out(stage, running, context, explicit):
    if stage is ENVIRONMENT:  # it lays down its own mark, since it begins by removing the folder
        stage.run(running, context)
        context.stamps().end(stage.name, stage.key(context, explicit))
        return
    key = stage.key(context, explicit)  # before it runs: what changes meanwhile counts next time
    context.stamps().begin(stage.name)
    stage.run(running, context)
    context.stamps().end(stage.name, key)


def _compile_kernels(context):
    """Compile the numba kernels now rather than in the middle of the first run."""
    command = [context.python, "-m", "uvms_bringup.warm"]
    return Background(command, context.env, context.log.with_name("kernels.log"))


def _compile_alone(context):
    """Compile the kernels anew after their sources have changed, and nothing else."""
    kernels = _compile_kernels(context)
    try:
        _finish(kernels, context)
    except BaseException:
        kernels.stop()
        raise


def _finish(kernels, context):
    key = kernel_sources(context.root)
    with Stage("compiling the numerical kernels", context.log) as running:
        running.watch(kernels)
    if kernels.fault is None:
        context.stamps().end(KERNELS, key)
    else:
        print("[set-up] kernels not compiled ahead; the first run will try.\n%s" % kernels.fault)


if __name__ == "__main__":
    sys.exit(main())
