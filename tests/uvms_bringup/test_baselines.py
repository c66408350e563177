"""The baselines that a run is compared with: each a word in the scenario, each in a real run."""

import numpy as np
import pytest

from uvms_bringup.errors import ScenarioError
from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_observer.truth import EXACT

CURRENT = ["plant.current_ned_m_s=[-0.08, 0.06, 0.0]"]


def ticks_of(name, settings, duration=3.0):
    scenario = load_scenario(name, settings, duration_s=duration)
    vehicle = scenario.load_vehicle()
    ticks = []
    simulate(scenario, vehicle, scenario.goal.build(vehicle, scenario.plant), observe=ticks.append)
    return ticks


@pytest.mark.parametrize(
    ("word", "long"),
    [
        ("control=off", "control={enabled: false}"),
        ("control=false", "control={enabled: false}"),
        ("control=paper", "control={law: paper}"),
        ("observer=none", "observer={law: none}"),
        ("planner=vehicle_only", "planner={method: vehicle_only}"),
        ("navigation=error_state_ekf", "navigation={filter: error_state_ekf}"),
        ("allocation=weighted_least_squares", "allocation={method: weighted_least_squares}"),
    ],
)
def test_a_section_may_be_one_word(word, long):
    assert load_scenario("hover", [word]) == load_scenario("hover", [long])


def test_a_scenario_file_may_have_words(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("duration_s: 1.0\ncontrol: off\nobserver: none\n", encoding="utf-8")
    scenario = load_scenario(str(path), ["control.observer=false"])
    assert (scenario.control.enabled, scenario.control.observer) == (False, False)
    assert scenario.observer.law == "none"


def test_values_of_one_run_do_not_get_into_the_next():
    shared = {"plant": {"initial_posture": "home"}, "control": {"observer": False}}
    other = load_scenario(
        "hover", values={**shared, "control.enabled": False, "plant.step_s": 0.01}
    )
    assert (other.control.enabled, other.plant.step_s) == (False, 0.01)
    again = load_scenario("hover", values=shared)
    assert again.control.enabled
    assert again.plant.step_s != 0.01
    assert shared == {"plant": {"initial_posture": "home"}, "control": {"observer": False}}


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("control=of", ["control.law", "'of'", "default, paper"]),
        (
            "observer=off",
            ["observer.law", "'off'", "combined, momentum, "],
        ),
        ("planner=frozen", ["planner.method", "'frozen'", "vehicle_only"]),
        ("control=true", ["control:"]),
        ("observer=false", ["observer:"]),
        ("navigation.source=gps", ["navigation.source", "'sensors' or 'truth'"]),
    ],
)
def test_a_word_that_names_nothing_is_refused_with_the_choices(setting, words):
    with pytest.raises(ScenarioError) as fault:
        load_scenario("hover", [setting])
    assert all(word in str(fault.value) for word in words), fault.value


def test_without_control_no_thruster_works_and_the_current_takes_the_vehicle():
    ticks = ticks_of("hover", ["control=off", *CURRENT], 20.0)
    assert not any(tick.wrench.wrench.any() for tick in ticks)
    assert not any(tick.thruster_command.thrust.any() for tick in ticks)
    drift = ticks[-1].truth.odometry.position[:2] - ticks[0].truth.odometry.position[:2]
    assert drift @ [-0.8, 0.6] > 0.3


def test_without_observer_nothing_is_fed_forward():
    ticks = ticks_of("arm_swing", ["observer=none"], 13.0)
    for tick in ticks:
        parts = (tick.budget.restoring, tick.budget.coupling, tick.budget.external)
        assert not any(part.any() for part in (*parts, tick.disturbance.wrench))
        assert tick.disturbance.stamp == tick.budget.stamp == tick.stamp
    known = [tick.wrench.wrench for tick in ticks]
    fed_nothing = ticks_of("arm_swing", ["control.observer=false"], 13.0)
    np.testing.assert_allclose(known, [t.wrench.wrench for t in fed_nothing], rtol=0, atol=1e-12)
    assert np.abs(known).max() > 0.1


def test_navigation_from_the_truth_is_the_truth_and_honest_about_it():
    ticks = ticks_of("hover", ["navigation.source=truth", *CURRENT])
    for tick in ticks:
        truth, estimate = tick.truth.odometry, tick.odometry
        assert estimate.stamp == truth.stamp == tick.stamp
        for name in ("position", "quaternion", "nu"):
            assert np.array_equal(getattr(estimate, name), getattr(truth, name)), name
        for covariance in (estimate.pose_covariance, estimate.twist_covariance):
            assert np.array_equal(covariance, EXACT**2 * np.eye(6))
    assert np.ptp([tick.truth.odometry.position for tick in ticks], axis=0).max() > 1e-4


def test_the_truth_takes_the_sensors_noise_out_of_the_loop_and_nothing_else():
    by_filter = ticks_of("hover", [])
    by_truth = ticks_of("hover", ["navigation.source=truth"])
    assert [tick.stamp for tick in by_truth] == [tick.stamp for tick in by_filter]

    def published(ticks):
        return [[topic.name for topic, _ in tick.outputs] for tick in ticks]

    assert published(by_truth) == published(by_filter)

    def chatter(ticks):
        return np.abs(np.diff([t.wrench.wrench for t in ticks[20:]], axis=0)).mean()

    assert chatter(by_truth) < 0.5 * chatter(by_filter)


def test_the_vehicle_alone_carries_the_tool_along_its_path():
    path = "goal.path={circle: {radius_m: 0.1, plane: XOZ, duration_s: 30}}"
    start = ["plant.initial_posture=home", "goal.path_made_for=null", path]
    settings = ["planner=vehicle_only", "navigation.source=truth", *start]
    ticks = ticks_of("manipulation", settings, 34.0)
    steps = [tick.plan for tick in ticks if tick.plan is not None]
    finished = [step.finished for step in steps if step.finished is not None]
    assert [end.success for end in finished] == [True]
    assert finished[0].max_planned_error < 2e-4  # between the knots
    references = [reference for step in steps for reference in step.references]
    joints = np.concatenate([reference.q for reference in references])
    assert np.ptp(joints, axis=0).max() < 1e-12
    moved = np.concatenate([reference.position for reference in references])
    assert np.ptp(moved, axis=0)[[0, 2]] == pytest.approx([0.2, 0.2], abs=2e-3)
