"""Write a log of one's own simulation, then read it back as arrays and summarise it.

Uses uvms_analysis on a vehicle that sinks with its arm at work: any program can write such a log,
which Foxglove and PlotJuggler open, too. Run it: python examples/analysis_summary.py
"""

import tempfile
from pathlib import Path

import numpy as np

from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.summary import summarise
from uvms_core import topics
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import dump_vehicle, load_vehicle
from uvms_dynamics.simulation import Plant, PlantConfig

vehicle = load_vehicle(overrides={"hull.mass_kg": 190.0})
plant = Plant(vehicle, PlantConfig(), seed=1)

with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "run.mcap"
    with LogWriter(path) as log:
        log.attach("vehicle.yaml", dump_vehicle(vehicle), "application/yaml")
        log.metadata("uvms", {"scenario": "sinking", "seed": 1})
        writer = SignalWriter(log, vehicle.joint_names, vehicle.thruster_names)
        while plant.stamp <= 10_000_000_000:
            truth = plant.truth()
            writer.write(topics.TRUE_ODOMETRY, truth.odometry)
            writer.write(topics.TRUE_JOINT_STATES, truth.joints)
            writer.write(topics.TRUE_DISTURBANCE, truth.disturbance)
            effort = np.array([2.0 * np.sin(1e-9 * plant.stamp), 0.0, 0.0, 0.0])
            plant.step(ThrusterCommand(plant.stamp, np.zeros(7)), JointCommand(plant.stamp, effort))
    size = path.stat().st_size
    run = RunLog.open(path)
    odometry = run.series(topics.TRUE_ODOMETRY)
    summary = summarise(run, wall_s=0.0)

print(f"{len(odometry)} samples of each topic in {size / 1000.0:.0f} kB: {', '.join(run.topics)}")
start, end = odometry.position[[0, -1], 2]
print(f"depth at the start and after {odometry.time[-1]:g} s: {start:.2f} m, {end:.2f} m")
for name in ("roll_deg", "end_effector_error_m", "self_disturbance", "navigation_error_m"):
    print(f"{name}: {summary[name]}")
