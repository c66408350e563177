"""Runge-Kutta steps per second on one thread: against MuJoCo's rollout with RK4 and its water."""

from collections.abc import Callable, Iterator

import mujoco
import mujoco.rollout
import numpy as np
from chains import JOINTS, chain
from compiled import STEP_S, STEPS, stepping
from metrics import Metric, Target
from motions import slow_motion
from mujoco_chain import FLUIDS, mujoco_model, mujoco_state
from paired import paired

from uvms_core.signals import Array

NAMES = {
    fluid: f"mujoco.rollout, one thread, RK4, {fluid.replace('_', ' ')} fluid" for fluid in FLUIDS
}


def measure(full: bool) -> Iterator[Metric]:
    """The same chain, state and step. MuJoCo's fluids are simpler: no added mass is solved for."""
    for n in JOINTS:
        vehicle, motion = chain(n), slow_motion(n)
        theirs = {
            name: rollout(mujoco_model(vehicle, STEP_S, fluid=fluid), motion)
            for fluid, name in NAMES.items()
        }
        timing = paired(stepping(vehicle, motion), theirs)
        for fluid, name in NAMES.items():
            yield Metric(
                f"rk4_steps_against_mujoco_{fluid}_n{n}", STEPS / timing.seconds, "1/s", name,
                1.0 / timing.ratio[name], Target("ratio", ">=", 4.0),
            )  # fmt: skip


def rollout(model: mujoco.MjModel, motion) -> Callable[[], Array]:
    """A call that makes STEPS steps from a motion in this thread; returns the last state."""
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = mujoco_state(motion.quat, motion.nu, motion.q, motion.q_dot)
    what = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start = np.empty(mujoco.mj_stateSize(model, what))
    mujoco.mj_getState(model, data, start, what)
    states = np.empty((1, STEPS, len(start)))
    runner = mujoco.rollout.Rollout(nthread=0)  # runs in the calling thread

    def work() -> Array:
        runner.rollout(model, data, start[None], nstep=STEPS, state=states)
        return states[0, -1]

    if not np.all(np.isfinite(work())) or any(warning.number for warning in data.warning):
        raise ArithmeticError("MuJoCo's run diverged")
    return work
