"""Scenarios: what a file may say, what follows from it, and what is refused with which words."""

import numpy as np
import pytest
from pydantic import BaseModel, ValidationError

from uvms_bringup import locate
from uvms_bringup.errors import ScenarioError
from uvms_bringup.goal import Goal, JointMotionSpec, start_of_end_effector
from uvms_bringup.scenario import (
    Scenario,
    known_scenarios,
    load_scenario,
)
from uvms_bringup.session import prepare
from uvms_bringup.simulate import simulate
from uvms_core.errors import ConfigError
from uvms_core.vehicle import Vehicle, dump_vehicle, load_vehicle, vehicle_from_data
from uvms_dynamics import end_effector
from uvms_dynamics.model.vehicle_table import build_model
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.plant.config import initial_joints_deg
from uvms_observer import NavigationConfig

SHORT = "duration_s: 1.0\n"


def written(tmp_path, text: str | bytes, name: str = "mine.yaml") -> str:
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return str(path)


def refusal(name: str, *settings: str) -> str:
    with pytest.raises(ScenarioError) as fault:
        load_scenario(name, settings)
    return str(fault.value)


def two_joints(vehicle: Vehicle) -> Vehicle:
    """The vehicle with the first two joints of its arm only."""
    data = vehicle.model_dump(mode="json")
    arm = data["arm"]
    arm |= {name: arm[name][:2] for name in ("joints", "links", "stowed_deg")}
    arm["postures_deg"] = {"home": {"shoulder": 30.0}}
    return vehicle_from_data(data)


@pytest.mark.parametrize("name", known_scenarios())
def test_what_comes_with_the_project_can_start(name):
    scenario = load_scenario(name)
    vehicle = scenario.load_vehicle()
    goal = scenario.build_goals(vehicle)
    assert (goal is None) == (name in ("hover", "grasp", "swell"))
    assert scenario.duration_s > sum(each.duration_s for each in scenario.goals or (scenario.goal,))


def test_what_a_run_writes_is_the_same_scenario_again():
    scenario = load_scenario("manipulation", ["plant.initial_position_m=[3, 4, 5]"])
    assert Scenario.model_validate(scenario.model_dump(mode="json")) == scenario


def test_a_file_in_another_encoding(tmp_path):
    path = written(tmp_path, b"duration_s: 1.0\ndescription: gr\xfcn\n")
    assert refusal(path) == (
        f"scenario {path}: cannot be read: byte 31 is not UTF-8; save the file as UTF-8"
    )


def test_a_key_given_twice(tmp_path):
    path = written(tmp_path, SHORT + "plant:\n  step_s: 0.005\n  step_s: 0.01\n")
    assert refusal(path) == (
        f"scenario {path}: is not valid YAML: line 4, column 3: the key 'step_s' is given twice"
    )


def test_a_file_that_is_no_mapping(tmp_path):
    path = written(tmp_path, "- 1\n")
    assert refusal(path) == f"scenario {path}: a scenario is a mapping of names to values"


def test_overrides_that_are_no_mapping_cannot_be_added_to(tmp_path):
    path = written(tmp_path, SHORT + "vehicle_overrides: 5\n")
    assert refusal(path, "vehicle.hull.mass_kg=190") == (
        "--set 'vehicle.hull.mass_kg=190': 'vehicle_overrides' is a value, not a group of values"
    )


def test_a_setting_adds_to_the_overrides_of_the_file(tmp_path):
    path = written(tmp_path, SHORT + "vehicle_overrides: {thrusters.main.limit_n: 50}\n")
    vehicle = load_scenario(path, ["vehicle.arm.joints.wrist.effort_limit_nm=7"]).load_vehicle()
    assert vehicle.thrusters[0].limit_n == 50.0
    assert vehicle.arm.joints[3].effort_limit_nm == 7.0


@pytest.mark.parametrize("name", ["../x", "/x", ".x", "", "a/b", "a\nb", "-x"])
def test_a_name_that_leads_elsewhere_is_refused(name):
    with pytest.raises(ValidationError, match="part of a folder's name"):
        Scenario(scenario=name, duration_s=1.0)


@pytest.mark.parametrize("name", ["hover", "my run 2", "Versuch_ä", "v1.2+b-c"])
def test_a_plain_name_is_taken(name):
    assert Scenario(scenario=name, duration_s=1.0).scenario == name


class TestNavigationStart:
    def test_is_the_plants_unless_given(self):
        scenario = load_scenario("hover", ["plant.initial_position_m=[30, -20, 900]"])
        assert scenario.navigation.initial_position_m == (30.0, -20.0, 900.0)
        assert Scenario(scenario="x", duration_s=1.0).navigation.initial_position_m == (0, 0, 10)

    def test_leaves_the_other_values_alone(self):
        scenario = load_scenario("hover", ["navigation.latency_s=0.5"])
        assert scenario.navigation == NavigationConfig(
            latency_s=0.5, initial_position_m=(0.0, 0.0, 10.0)
        )

    def test_may_be_wrong_on_purpose(self):
        settings = ["navigation.initial_position_m=[5, 0, 0]"]
        scenario = load_scenario("hover", settings)
        assert scenario.navigation.initial_position_m == (5.0, 0.0, 0.0)
        assert scenario.plant.initial_position_m == (0.0, 0.0, 10.0)

    def test_with_a_wrong_plant_the_plant_alone_is_to_blame(self):
        text = refusal("hover", "plant.initial_position_m=[1]")
        assert {line.split(": ")[1].rsplit(".", 1)[0] for line in text.splitlines()} == {
            "plant.initial_position_m"
        }


class TestJointMotionSpec:
    @pytest.mark.parametrize(
        ("times", "positions", "text"),
        [
            ([], [], "at least 1 item"),
            ([0.0], [[1.0]], r"times_s must be > 0 and increasing, are \[0.0\]"),
            ([2.0, 2.0], [[1.0], [1.0]], r"times_s must be > 0 and increasing, are \[2.0, 2.0\]"),
            ([1.0, 2.0], [[1.0]], "positions_deg has 1 rows for 2 times"),
            ([1.0], [[float("nan")]], "finite number"),
        ],
    )
    def test_a_table_with_holes_is_refused(self, times, positions, text):
        with pytest.raises(ValidationError, match=text):
            JointMotionSpec(times_s=times, positions_deg=positions)

    def test_every_way_to_give_a_point_in_si_units(self):
        vehicle = two_joints(load_scenario("hover").load_vehicle())
        points = ((90.0, 0.0), {"shoulder": 45.0}, "home", "stowed")
        motion = JointMotionSpec(times_s=(1.0, 3.0, 5.0, 7.0), positions_deg=points)
        goal = Goal(joints=motion).build(vehicle, PlantConfig())
        np.testing.assert_array_equal(goal.times, [1.0, 3.0, 5.0, 7.0])
        expected = [[90.0, 0.0], [90.0, 45.0], [0.0, 30.0], [0.0, 0.0]]
        np.testing.assert_allclose(goal.positions, np.radians(expected))

    def test_joints_that_the_first_point_leaves_out_stay_at_the_start(self):
        vehicle = two_joints(load_scenario("hover").load_vehicle())
        motion = JointMotionSpec(times_s=(1.0,), positions_deg=({"swing": 5.0},))
        goal = Goal(joints=motion).build(vehicle, PlantConfig(initial_posture="home"))
        np.testing.assert_allclose(goal.positions, np.radians([[5.0, 30.0]]))


class TestStartOfTheArm:
    @pytest.mark.parametrize(
        ("settings", "expected"),
        [
            ([], (0.0, 0.0, 135.0, 0.0)),
            (["plant.initial_posture=home"], (0.0, 10.0, 115.0, 0.0)),
            (["plant.initial_joints_deg={elbow: 90}"], (0.0, 0.0, 90.0, 0.0)),
            (
                ["plant.initial_posture=home", "plant.initial_joints_deg={elbow: 90}"],
                (0.0, 10.0, 90.0, 0.0),
            ),
            (
                ["plant.initial_posture=home", "plant.initial_joints_deg=[1, 2, 3, 4]"],
                (1.0, 2.0, 3.0, 4.0),
            ),
        ],
    )
    def test_every_way_to_give_it(self, settings, expected):
        scenario = load_scenario("hover", settings)
        vehicle = scenario.load_vehicle()
        assert initial_joints_deg(vehicle, scenario.plant) == expected
        assert scenario.for_vehicle(vehicle).plant.initial_joints_deg == expected

    @pytest.mark.parametrize(
        ("setting", "text"),
        [
            (
                "plant.initial_posture=folded",
                "plant.initial_posture: the vehicle has no posture 'folded'; choose one of stowed,"
                " home, extended_starboard, extended_port, or add it to arm.postures_deg in the"
                " vehicle file",
            ),
            (
                "plant.initial_joints_deg={knee: 1}",
                "plant.initial_joints_deg: there is no joint 'knee'; the joints are swing,"
                " shoulder, elbow, wrist",
            ),
            (
                "plant.initial_joints_deg={elbow: 141}",
                "plant.initial_joints_deg: 141 of joint elbow is outside its limits 0 to 140",
            ),
        ],
    )
    def test_what_does_not_fit_is_named(self, setting, text):
        with pytest.raises(ScenarioError) as fault:
            load_scenario("hover", [setting]).load_vehicle()
        assert str(fault.value) == text


class TestPathsOfFiles:
    def test_a_vehicle_is_looked_for_beside_the_scenario(self, tmp_path, monkeypatch):
        (tmp_path / "sub").mkdir()
        written(tmp_path, dump_vehicle(load_vehicle()), "sub/own.yaml")
        path = written(tmp_path, SHORT + "vehicle: sub/own.yaml\n")
        monkeypatch.chdir(tmp_path / "sub")
        assert load_scenario(path).vehicle == str(tmp_path / "sub" / "own.yaml")
        assert load_scenario("../mine.yaml").load_vehicle().n_joints == 4

    @pytest.mark.parametrize("as_setting", [True, False])
    def test_on_the_command_line_in_the_working_directory(self, as_setting, tmp_path, monkeypatch):
        (tmp_path / "sub").mkdir()
        written(tmp_path, dump_vehicle(load_vehicle()), "own.yaml")
        path = written(tmp_path, SHORT, "sub/mine.yaml")
        monkeypatch.chdir(tmp_path)
        settings = ["vehicle=own.yaml", "goal.path_made_for=own.yaml"] if as_setting else []
        scenario = load_scenario(path, settings, vehicle="own.yaml")
        assert scenario.vehicle == str(tmp_path / "own.yaml")
        assert scenario.goal.path_made_for == (scenario.vehicle if as_setting else None)

    def test_what_a_run_writes_runs_again_from_anywhere(self, tmp_path, monkeypatch):
        """With the vehicle as it was, overrides and all, also after the folder has moved."""
        settings = ["vehicle.hull.mass_kg=190", "duration_s=0.1", "seed=7"]
        scenario = load_scenario("manipulation", settings)
        session = prepare(scenario, str(tmp_path / "run"), "lockstep", "test")
        first = session.run_simulation()
        (tmp_path / "run").rename(tmp_path / "moved")
        monkeypatch.chdir(tmp_path)
        again = load_scenario("moved/config.yaml")
        assert again.load_vehicle() == session.vehicle
        assert again.seed == 7
        repeat = prepare(again, str(tmp_path / "again"), "lockstep", "test")
        np.testing.assert_array_equal(repeat.goal.positions, session.goal.positions)
        second = repeat.run_simulation()
        timing = {"run_id", "wall_s", "start_up_s", "real_time_factor", "planner_step_ms"}
        for key in first.keys() - timing:
            assert first[key] == second[key], key


class TestOtherVehicles:
    def test_hover_takes_any_number_of_joints(self, tmp_path):
        vehicle = two_joints(load_scenario("hover").load_vehicle())
        path = written(tmp_path, dump_vehicle(vehicle), "vehicle.yaml")
        loaded = load_scenario("hover", vehicle=path).load_vehicle()
        assert loaded.n_joints == 2

    def test_a_motion_of_other_joints_is_refused(self, tmp_path):
        vehicle = two_joints(load_scenario("hover").load_vehicle())
        points = "{times_s: [9], positions_deg: [[0, 0, 90, 0]]}"
        scenario = load_scenario("arm_swing", [f"goal.joints={points}"])
        with pytest.raises(ScenarioError) as fault:
            scenario.goal.build(vehicle, scenario.plant)
        assert str(fault.value) == (
            "goal.joints.positions_deg.0: has 4 values for 2 joints: swing, shoulder"
        )

    def test_a_start_of_other_joints_is_refused(self, tmp_path):
        vehicle = two_joints(load_scenario("hover").load_vehicle())
        path = written(tmp_path, dump_vehicle(vehicle), "vehicle.yaml")
        settings = ["plant.initial_joints_deg=[0, 10, 115, 0]"]
        scenario = load_scenario("manipulation", settings, vehicle=path)
        with pytest.raises(ScenarioError) as fault:
            scenario.load_vehicle()
        assert str(fault.value) == (
            "plant.initial_joints_deg: has 4 values for 2 joints: swing, shoulder"
        )

    def test_a_posture_that_the_vehicle_lacks_is_refused(self):
        vehicle = two_joints(load_scenario("hover").load_vehicle())
        scenario = load_scenario("arm_swing")
        with pytest.raises(ScenarioError) as fault:
            scenario.goal.build(vehicle, scenario.plant)
        assert str(fault.value) == (
            "goal.joints.positions_deg.0: the vehicle has no posture 'extended_starboard'; choose"
            " one of stowed, home, or add it to arm.postures_deg in the vehicle file"
        )


def test_the_end_effector_starts_with_the_arm_stowed_where_no_joints_are_given():
    vehicle = load_scenario("hover").load_vehicle()
    position, _ = start_of_end_effector(vehicle, PlantConfig(initial_position_m=(1.0, 2.0, 3.0)))
    stowed = np.radians(vehicle.arm.stowed_deg)
    level = np.array([0.0, 0.0, 0.0, 1.0])
    expected, _ = end_effector(build_model(vehicle), np.array([1.0, 2.0, 3.0]), level, stowed)
    np.testing.assert_allclose(position, expected)
    with pytest.raises(ConfigError, match="has 1 values for 4 joints"):
        start_of_end_effector(vehicle, PlantConfig(initial_joints_deg=(0.0,)))


@pytest.mark.parametrize(
    "settings",
    [
        ["plant.step_s=0.0025"],
        ["plant.control_period_s=0.1"],
        ["plant.control_period_s=0.01"],
        ["planner.step_s=0.05"],
        ["vehicle.sensors.imu.rate_hz=200"],
        ["vehicle.sensors.imu.rate_hz=20"],
    ],
)
def test_periods_that_fit_are_taken(settings):
    assert load_scenario("hover", settings).load_vehicle().n_joints == 4


def numbers(value):
    """Every float in a configuration."""
    if isinstance(value, BaseModel):
        value = dict(value)
    if isinstance(value, dict):
        value = tuple(value.values())
    if isinstance(value, (tuple, list)):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, float):
        yield value


def test_every_default_is_finite():
    found = list(numbers(Scenario(scenario="x", duration_s=1.0)))
    assert len(found) > 100
    assert np.isfinite(found).all()


def paths_to_floats(values, prefix=""):
    for key, value in values.items():
        if isinstance(value, dict):
            yield from paths_to_floats(value, f"{prefix}{key}.")
        elif isinstance(value, float):
            yield f"{prefix}{key}"


@pytest.mark.parametrize("word", [".nan", ".inf", "-.inf", "nan"])
def test_no_parameter_takes_what_is_not_finite(word):
    paths = list(paths_to_floats(load_scenario("hover").model_dump()))
    assert len(paths) > 50
    for path in paths:
        assert f"{path}: Input should be a finite number" in refusal("hover", f"{path}={word}")


def test_a_deep_start_is_known_to_navigation():
    """With a start at the surface the filter would refuse the pressure for seconds."""
    scenario = load_scenario("hover", ["plant.initial_position_m=[0, 0, 900]"], duration_s=0.2)
    errors = []
    simulate(
        scenario,
        scenario.load_vehicle(),
        None,
        observe=lambda tick: errors.append(
            tick.odometry.position[2] - tick.truth.odometry.position[2]
        ),
    )
    assert len(errors) == 5
    assert np.abs(errors).max() < 0.1


def test_the_installed_share_folder_is_found(tmp_path, monkeypatch):
    """An installed package has no source tree beside it."""
    share = tmp_path / "share" / "uvms_bringup" / "config" / "scenarios"
    share.mkdir(parents=True)
    monkeypatch.setattr(locate, "__file__", str(tmp_path / "lib" / "uvms_bringup" / "locate.py"))
    monkeypatch.setattr(locate.sys, "prefix", "/nowhere/else")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/nowhere:{tmp_path}")
    assert locate.scenario_folder() == share
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/nowhere")
    with pytest.raises(ScenarioError, match=r"were not found; looked for\n  .*\n  /nowhere/share/"):
        locate.scenario_folder()


@pytest.mark.parametrize(
    ("settings", "share", "external"),
    [
        ([], 0.8, None),
        (["allocation.lag_compensation=0.3"], 0.3, None),
        (["allocation.method=weighted_least_squares"], 0.0, None),
        (["observer.external_bandwidth_rad_s=2.0"], 0.8, 2.0),
        (["allocation.lag_compensation=0.3", "control.gains.lag_compensation=0.5"], 0.5, None),
    ],
)
def test_gains_are_laid_out_for_observer_and_allocator_as_they_are(settings, share, external):
    gains = load_scenario("hover", settings).control.gains
    assert gains.lag_compensation == share
    assert gains.external_bandwidth_rad_s == external
