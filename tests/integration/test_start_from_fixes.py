"""A filter that begins anywhere publishes nothing before it knows where it is, and goals wait."""

import numpy as np
import pytest

from uvms_bringup.agenda import Agenda
from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_core import topics
from uvms_core.signals import to_seconds

SILENT_S = 3.0
SETTINGS = [
    "plant.initial_position_m=[12.0, -7.0, 0.0]",
    "navigation.initial_position_m=[0.0, 0.0, 0.0]",
    "navigation.start=fixes",
    "vehicle.sensors.gps.horizontal_noise_m=0.02",
    "goal={pose: {position_m: [12.0, -7.0, 0.03], frame: map_ned, hold_s: 2.0}}",
    f"events=[{{at_s: 0.0, until_s: {SILENT_S}, sensor: gps, fault: silent}}]",
]

NO_GOAL = "goal={}"


def run(*further):
    """Ticks of a run of 8 s, and its goals."""
    scenario = load_scenario("hover", [*SETTINGS, *further], duration_s=8.0)
    vehicle = scenario.load_vehicle()
    scenario = scenario.for_vehicle(vehicle)
    agenda, ticks = Agenda(scenario.build_goals(vehicle)), []
    simulate(scenario, vehicle, agenda, observe=ticks.append)
    return ticks, agenda.records()


def first_odometry(ticks):
    """Index of the first tick with odometry."""
    return next(k for k, tick in enumerate(ticks) if tick.odometry is not None)


@pytest.fixture(scope="module")
def late():
    return run()


def test_nothing_is_published_before_the_first_fix(late):
    ticks, _ = late
    first = first_odometry(ticks)
    assert to_seconds(ticks[first].stamp) == pytest.approx(SILENT_S, abs=1.01)
    assert all(tick.odometry is not None for tick in ticks[first:])
    for tick in ticks[:first]:
        assert tick.newest(topics.REFERENCE) is None
        assert not np.any(tick.wrench.wrench)
        assert not np.any(tick.thruster_command.thrust)


def test_the_first_estimate_is_right_within_what_it_says(late):
    ticks, _ = late
    for tick in ticks[first_odometry(ticks) :]:
        error = tick.odometry.position - tick.truth.odometry.position
        std = np.sqrt(np.diagonal(tick.odometry.pose_covariance)[:3])
        assert (np.abs(error) < 4.0 * std).all()
        assert (std[:2] < 0.1).all()


def test_diagnostics_say_what_it_waits_for(late):
    ticks, _ = late
    texts = [
        signal.message
        for tick in ticks[: first_odometry(ticks)]
        for topic, signal in tick.outputs
        if topic is topics.DIAGNOSTICS and signal.name == topics.NAVIGATION
    ]
    assert any(
        "waiting for a horizontal position (GPS, position fix or marker)" in t for t in texts
    )


def test_the_goal_waits_for_it(late):
    ticks, (goal,) = late
    first = to_seconds(ticks[first_odometry(ticks)].stamp)
    assert goal["state"] == "succeeded"
    assert first <= goal["began_s"] <= first + 0.51


def test_a_vehicle_that_moves_finds_its_velocity_from_the_dvl_or_from_fixes_alone():
    moving = "plant.initial_velocity=[0.4, 0.0, 0.0, 0.0, 0.0, 0.0]"
    ticks, _ = run(moving, "events=[]", NO_GOAL)
    assert first_odometry(ticks) == 0
    assert ticks[0].odometry.nu[0] == pytest.approx(0.4, abs=0.02)
    silent = "events=[{at_s: 0.0, sensor: dvl, fault: silent}]"
    ticks, _ = run(moving, silent, "navigation.known_within_m_s=0.1", NO_GOAL)
    first = first_odometry(ticks)
    assert to_seconds(ticks[first].stamp) >= 1.0  # one fix says nothing of the velocity
    error = ticks[first].odometry.nu[:3] - ticks[first].truth.odometry.nu[:3]
    assert np.linalg.norm(error) < 0.3


def test_given_pose_and_velocity_begin_at_once():
    given = ["navigation.start=given", "navigation.initial_position_m=[12.0, -7.0, 0.0]"]
    moving = ["plant.initial_velocity=[0.4, 0.0, 0.0, 0.0, 0.0, 0.0]"]
    known = [
        "navigation.initial_velocity_m_s=[0.4, 0.0, 0.0]",
        "navigation.initial_velocity_std_m_s=0.01",
    ]
    silent = ["events=[{at_s: 0.0, sensor: dvl, fault: silent}]"]
    ticks, _ = run(*given, *moving, *known, *silent, NO_GOAL)
    assert first_odometry(ticks) == 0
    error = ticks[20].odometry.nu[:3] - ticks[20].truth.odometry.nu[:3]
    assert np.linalg.norm(error) < 0.03
