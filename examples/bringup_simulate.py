"""Simulate a scenario without ROS, in two currents, and read the logs as arrays.

Uses uvms_bringup and uvms_analysis; the log and the summary are those of `uvms run`.
Run it: python examples/bringup_simulate.py
"""

import tempfile
from pathlib import Path

import numpy as np

from uvms_analysis.log.read import RunLog
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_core import topics

with tempfile.TemporaryDirectory() as folder:
    for current in ("[0.0, 0.0, 0.0]", "[-0.15, 0.1, 0.0]"):
        scenario = load_scenario("hover", [f"plant.current_ned_m_s={current}"], duration_s=20.0)
        output = Path(folder) / f"current-{current}"
        session = prepare(scenario, str(output), "lockstep", "examples/bringup_simulate.py")
        summary = session.run_simulation()
        log = RunLog.open(output / "run.mcap")
        thrust = log.series(topics.THRUSTER_COMMAND)
        truth, budget = log.series(topics.TRUE_ODOMETRY), log.series(topics.DISTURBANCE_BUDGET)
        print(f"\nhover for {truth.time[-1]:g} s in a current of {current} m/s")
        print(f"  files: {', '.join(sorted(path.name for path in output.iterdir()))}")
        print(f"  farthest from the start: {np.linalg.norm(np.ptp(truth.position, axis=0)):.4f} m")
        print(f"  thrust at the end, N: {np.round(thrust.thrust[-1], 2)}")
        print(f"  external force observed at the end, N: {np.round(budget.external[-1, :3], 2)}")
        print(f"  real-time factor {summary['real_time_factor']:.0f}")
