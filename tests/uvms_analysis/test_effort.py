"""What a run cost, and how consistent its filter is, from logs whose figures are known."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic import Known, write_log

from uvms_analysis import effort
from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.navigation_check import (
    attitude_error_deg,
    normalized_error,
    sensors,
    share_within,
)
from uvms_core import topics
from uvms_core.diagnostics import Status
from uvms_core.signals import (
    Allocation,
    AppliedThrust,
    JointCommand,
    JointStates,
    Odometry,
    to_nanoseconds,
)
from uvms_core.vehicle import dump_vehicle, load_vehicle
from uvms_core.vehicle.thrusters import Thruster
from uvms_dynamics.kernels.rotations import rpy_to_quat

TICKS = np.arange(0.0, 10.01, 0.05)
SIGMA = np.array([0.1, 0.2, 0.3])


def odometry(stamp, position, nu, yaw=0.0):
    covariance = np.diag([*SIGMA**2, 1e-6, 1e-6, 1e-6])
    attitude = rpy_to_quat(0.0, 0.0, yaw)
    return Odometry(stamp, np.array(position), attitude, np.array(nu), covariance, covariance)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """10 s at 2 m/s against 3 N, a joint at 0.5 rad/s against 4 N m; thruster 1 astern."""
    path = tmp_path_factory.mktemp("run") / "run.mcap"
    vehicle = load_vehicle()
    n, m = len(vehicle.joint_names), len(vehicle.thruster_names)
    rates, torques, thrust = np.zeros(n), np.zeros(n), np.zeros(m)
    rates[1], torques[1] = 0.5, -4.0
    thrust[0] = 0.25 * vehicle.thrusters[0].ahead_n
    thrust[1] = 0.5 * vehicle.thrusters[1].astern_n
    wrench = np.array([3.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    with LogWriter(path) as log:
        log.attach("vehicle.yaml", dump_vehicle(vehicle))
        signals = SignalWriter(log, vehicle.joint_names, vehicle.thruster_names)
        for time in TICKS:
            stamp = to_nanoseconds(float(time))
            nu = [2.0, 0.0, 0.0, 0.0, 0.0, 0.0]
            true = odometry(stamp, [2.0 * time, 0.0, 10.0], nu, np.pi - 0.01)
            signals.write(topics.TRUE_ODOMETRY, true)
            off = [2.0 * time + 0.1, 0.4, 10.0]
            signals.write(topics.ODOMETRY, odometry(stamp, off, nu, -np.pi + 0.01))
            joints = JointStates(stamp, 0.5 * time * (rates > 0), rates, np.zeros(n))
            for topic in (topics.JOINT_STATES, topics.TRUE_JOINT_STATES):
                signals.write(topic, joints)
            signals.write(topics.JOINT_COMMAND, JointCommand(stamp, torques))
            allocation = Allocation(stamp, thrust, wrench, 0.0 * wrench, np.zeros(m, bool))
            signals.write(topics.ALLOCATION, allocation)
            before = max(stamp - to_nanoseconds(0.05), 0)
            used = AppliedThrust(stamp, thrust, thrust, before, before, time == 0.0, False)
            signals.write(topics.APPLIED_THRUST, used)
        said = {"imu_accepted": 90, "imu_gated": 2, "imu_level": 1.1}
        signals.write(topics.DIAGNOSTICS, Status(stamp, "navigation", values=said))
    return Analysis(RunLog.open(path))


def test_load_and_what_is_left(run):
    shares = effort.load_shares(run)
    assert shares[:, 0] == pytest.approx(0.25)
    assert shares[:, 1] == pytest.approx(0.5)
    assert effort.authority_left(run) == pytest.approx(0.5)
    total = 0.25 * run.vehicle.thrusters[0].ahead_n - 0.5 * run.vehicle.thrusters[1].astern_n
    assert effort.total_thrust(run) == pytest.approx(total)


def test_a_thruster_has_another_limit_astern():
    """Thrust of 5 N ahead of 10 N, and of -3 N astern of 4 N; one that does not reverse."""
    common = {"position_m": (0.0, 0.0, 0.0), "direction": (1.0, 0.0, 0.0)}
    common |= {"time_constant_s": 0.1, "slew_limit_n_s": 100.0}
    items = [
        Thruster(name="a", limits_n=(-4.0, 10.0), **common),
        Thruster(name="b", limits_n=(-4.0, 10.0), **common),
        Thruster(name="c", limits_n=(0.0, 8.0), **common),
    ]
    thrust = np.array([[5.0, -3.0, 2.0]])
    assert effort.shares(thrust, items)[0] == pytest.approx([0.5, 0.75, 0.25])
    with pytest.raises(LogError, match="3 thrusts are allocated to 2 thrusters"):
        effort.shares(thrust, items[:2])


def test_work_is_force_times_way(run):
    """3 N over 20 m, and -4 N m through 5 rad."""
    assert effort.integral(*effort.thruster_power(run)) == pytest.approx(60.0)
    assert effort.integral(*effort.arm_power(run)) == pytest.approx(-20.0)
    limit = run.vehicle.arm.joints[1].effort_limit_nm
    assert effort.torque_shares(run)[1].max() == pytest.approx(4.0 / limit)


def test_commands_are_one_period_old_and_the_safe_state_has_none(run):
    time, age = effort.command_age(run)
    assert np.isnan(age[0])
    assert age[1:] == pytest.approx(0.05)
    assert len(time) == len(TICKS)


def test_the_error_against_its_covariance(run):
    """One, two and no standard deviations off: (1 + 4 + 0) / 3."""
    time, nees = normalized_error(run)
    assert nees == pytest.approx(5.0 / 3.0)
    assert len(time) == len(TICKS)
    assert share_within(run) == 1.0
    assert attitude_error_deg(run)[1][:, 2] == pytest.approx(np.rad2deg(0.02))


def test_a_covariance_that_is_none_is_refused(tmp_path):
    still = odometry(0, [0.0, 0.0, 10.0], np.zeros(6))
    sure = replace(still, pose_covariance=np.zeros((6, 6)))
    vehicle = load_vehicle()
    zeros = np.zeros(len(vehicle.joint_names))
    with LogWriter(tmp_path / "run.mcap") as log:
        signals = SignalWriter(log, vehicle.joint_names, vehicle.thruster_names)
        signals.write(topics.TRUE_ODOMETRY, still)
        signals.write(topics.ODOMETRY, sure)
        signals.write(topics.TRUE_JOINT_STATES, JointStates(0, zeros, zeros, zeros))
    with pytest.raises(LogError, match="not positive definite"):
        normalized_error(Analysis(RunLog.open(tmp_path / "run.mcap")))


def test_what_navigation_says_of_its_sensors(run, tmp_path):
    assert sensors(run.log) == {"imu": {"accepted": 90.0, "gated": 2.0, "level": 1.1}}
    write_log(tmp_path / "run.mcap", replace(Known(), duration=1.0))
    with pytest.raises(LogError, match="says nothing of its sensors"):
        sensors(RunLog.open(tmp_path / "run.mcap"))
