"""Plan a path of the end effector, once by the genetic method and once with the arm alone.

Uses uvms_planner: a path in phases becomes a goal; every step of 0.5 s gives a reference, which is
the motion of vehicle and joints together. Run it: python examples/planner_path.py
"""

import numpy as np

from uvms_core.signals import JointStates, Odometry, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import rpy_to_quat
from uvms_planner import MotionPlanner, PathPhase, PathSpec, PlannerConfig

PATH = PathSpec(
    phases=(
        PathPhase(duration_s=40.0, to_m=(0.0, 0.0, 0.15)),
        PathPhase(duration_s=40.0, to_m=(0.0, 0.0, 0.0), bulge_m=(0.05, 0.05, 0.0)),
    )
)
vehicle = load_vehicle()
q = np.radians([0.0, 10.0, 115.0, 0.0])
place, level, no_cov = np.array([0.0, 0.0, 10.0]), rpy_to_quat(0.0, 0.0, 0.0), np.zeros((6, 6))

for method in ("arm_only", "genetic"):
    planner = MotionPlanner(vehicle, PlannerConfig(method=method), seed=1)
    print(f"\n{method}\n  time   vehicle x, y, z (m)        joints (deg)               |F_dis|")
    moments, result = [], None
    for index in range(200):
        stamp = to_nanoseconds(0.5 * index)
        odometry = Odometry(stamp, place, level, np.zeros(6), no_cov, no_cov)
        step = planner.step(stamp, odometry, JointStates(stamp, q, 0 * q, 0 * q))
        if index == 0:
            planner.accept(PATH.goal(*planner.end_effector))
        if step.step is not None:
            moments.append(np.linalg.norm(step.step.self_disturbance[3:]))
            if index % 20 == 0:
                end = step.references[-1]
                x, joints = end.position[-1], np.degrees(end.q[-1])
                numbers = "".join(f"{value:8.3f}" for value in x)
                numbers += "  " + "".join(f"{value:7.1f}" for value in joints)
                print(f"{0.5 * index:6.1f}{numbers}{moments[-1]:10.3f} N m")
        if step.finished is not None:
            result = step.finished
            break
    print(f"{result.message}; self-disturbance {np.sqrt(np.mean(np.square(moments))):.3f} N m rms")
