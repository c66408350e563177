"""Simulate a scenario without ROS, with a change of its own, and read the log as arrays.

Uses uvms_bringup: the same log and the same figures as `uvms run` leaves.
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
        true, seen = log.series(topics.TRUE_ODOMETRY), log.series(topics.DISTURBANCE_BUDGET)
        print(f"\nhover for {true.time[-1]:g} s in a current of {current} m/s")
        print(f"  files: {', '.join(sorted(path.name for path in output.iterdir()))}")
        print(f"  farthest from the start: {np.linalg.norm(np.ptp(true.position, axis=0)):.4f} m")
        print(f"  thrust at the end, N: {np.round(thrust.thrust[-1], 2)}")
        print(f"  external force observed at the end, N: {np.round(seen.external[-1, :3], 2)}")
        print(f"  real-time factor {summary['real_time_factor']:.0f}")
