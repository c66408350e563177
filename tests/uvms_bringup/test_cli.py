"""The command line: every mistake ends in one error that says what is wrong and what is allowed."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from uvms_analysis.log.read import RunLog
from uvms_bringup.cli import main
from uvms_core import registry

BRINGUP = Path(__file__).parents[2] / "bringup" / "bringup.py"
COMMANDS = ("run", "simulate", "replay", "report")


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    """Whatever a command writes goes to the test's own folder."""
    monkeypatch.chdir(tmp_path)


def error_of(capsys, *arguments) -> str:
    """Text of the one error of a command that ends with code 2 and has done nothing."""
    assert main([*arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: ")
    assert err.count("error: ") == 1
    assert "Traceback" not in err
    assert not Path("runs").exists()
    return err.removeprefix("error: ").removesuffix("\n")


HOVER = "scenario hover.yaml: "
JOINTS = "4 joints: swing, shoulder, elbow, wrist"
PERIOD = "is not a multiple of"


@pytest.mark.parametrize("command", ["run", "simulate"])
@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--duration", "inf"], f"{HOVER}duration_s: Input should be a finite number (got inf)"),
        (["--duration", "nan"], f"{HOVER}duration_s: Input should be a finite number (got nan)"),
        (
            ["--duration", "2e6"],
            f"{HOVER}duration_s: Input should be less than or equal to 1000000 (got 2000000.0)",
        ),
        (["--duration", "-1"], f"{HOVER}duration_s: Input should be greater than 0 (got -1.0)"),
        (["--seed", "-1"], f"{HOVER}seed: Input should be greater than or equal to 0 (got -1)"),
        (
            ["--seed", str(2**63)],
            f"{HOVER}seed: Input should be less than or equal to {2**63 - 1} (got {2**63})",
        ),
        (["--vehicle", "none.yaml"], "{cwd}/none.yaml: cannot be read: No such file or directory"),
        (
            ["--vehicle", "foo"],
            "unknown vehicle 'foo'; choose one of bluerov2_alpha5, reference_auv,"
            " reference_auv_heavy, reference_auv_light, reference_auv_three_thrusters,"
            " or a YAML file",
        ),
        (
            ["--pace", "realtime:0"],
            "pace 'realtime:0': choose lockstep, realtime, or realtime:FACTOR"
            " with 0 < FACTOR <= 1000",
        ),
        (
            ["--pace", "fast"],
            "pace 'fast': choose lockstep, realtime, or realtime:FACTOR with 0 < FACTOR <= 1000",
        ),
        (
            ["--set", "control.obsrver=false"],
            f"{HOVER}control.obsrver: Extra inputs are not permitted; known names here:"
            " arm, compensate_vehicle_motion, compensation, enabled, gains, law, observer,"
            " parameters, vehicle",
        ),
        (
            ["--set", "plant.initial_joints_deg=[0]"],
            f"plant.initial_joints_deg: has 1 values for {JOINTS}",
        ),
        (
            ["--set", "plant.initial_joints_deg=[0, 0, 200, 0]"],
            "plant.initial_joints_deg: 200 of joint elbow is outside its limits 0 to 140",
        ),
        (
            ["--set", "control.vehicle.k_rate=[.nan, 2, 2, 2, 2, 2]"],
            f"{HOVER}control.vehicle.k_rate.0: Input should be a finite number (got nan)",
        ),
        (
            ["--set", "plant.current_ned_m_s=[0, inf, 0]"],
            f"{HOVER}plant.current_ned_m_s.1: Input should be a finite number (got 'inf')",
        ),
        (
            ["--set", "scenario=../../x"],
            f"{HOVER}scenario: it becomes part of a folder's name: start with a"
            " letter or digit, then use letters, digits, spaces and the signs _ . + -"
            " (got '../../x')",
        ),
        (
            ["--set", "control.observer"],
            "--set 'control.observer': write PATH=VALUE, such as control.observer=false",
        ),
        (["--set", "=3"], "--set '=3': write PATH=VALUE, such as control.observer=false"),
        (
            ["--set", "duration_s=[1"],
            "--set 'duration_s=[1': '[1': is not valid YAML: line 1, column 3:"
            " expected ',' or ']', but got '<stream end>'",
        ),
        (
            ["--set", "seed=2020-99-99"],
            "--set 'seed=2020-99-99': '2020-99-99': is not valid YAML: month must be in 1..12",
        ),
        (
            ["--set", "duration_s.x=3"],
            "--set 'duration_s.x=3': 'duration_s' is a value, not a group of values",
        ),
        (
            ["--set", "goal.joints={times_s: [1, 2], positions_deg: [[0], [1, 2]]}"],
            f"goal.joints.positions_deg.0: has 1 values for {JOINTS}",
        ),
        (
            ["--set", "goal.joints={times_s: [1], positions_deg: [[0, 1]]}"],
            f"goal.joints.positions_deg.0: has 2 values for {JOINTS}",
        ),
        (
            ["--set", "planner.step_s=0.07"],
            f"planner.step_s: 0.07 s {PERIOD} plant.control_period_s: 0.05 s",
        ),
        (
            ["--set", "plant.control_period_s=0.012"],
            f"plant.control_period_s: 0.012 s {PERIOD} plant.step_s: 0.005 s",
        ),
        (
            ["--set", "vehicle.sensors.imu.rate_hz=8"],
            f"plant.control_period_s: 0.05 s {PERIOD} the period of"
            " vehicle.sensors.imu.rate_hz = 8: 0.125 s",
        ),
        (
            ["--set", "vehicle.sensors.dvl.rate_hz=60"],
            f"the period of vehicle.sensors.dvl.rate_hz = 60: 0.0166667 s {PERIOD}"
            " plant.step_s: 0.005 s",
        ),
        (
            ["--set", "vehicle.hull.mas_kg=190"],
            "override hull.mas_kg: hull has no 'mas_kg'; choose from spheroid, volume_m3, mass_kg,"
            " cg_m, cb_m, inertia_kg_m2, added_mass, attachments, linear_damping,"
            " quadratic_damping, cross_terms, fins, boxes, speeds_m_s",
        ),
    ],
)
def test_a_wrong_option_is_refused_before_anything_is_made(capsys, command, options, text):
    assert error_of(capsys, command, "hover", *options) == text.replace("{cwd}", str(Path.cwd()))


def test_a_wrong_value_of_an_override_names_the_override(capsys):
    text = error_of(capsys, "simulate", "hover", "--set", "vehicle.hull.mass_kg=-3")
    assert text.endswith(
        "reference_auv.yaml with hull.mass_kg=-3: hull.mass_kg:"
        " Input should be greater than 0 (got -3)"
    )


def test_an_unstable_step_names_its_parameter(capsys):
    slow = [f"vehicle.sensors.{name}.rate_hz=1" for name in ("imu", "dvl", "pressure", "gps")]
    settings = ["plant.step_s=0.05", "plant.control_period_s=1", "planner.step_s=1", *slow]
    options = [word for setting in settings for word in ("--set", setting)]
    text = error_of(capsys, "simulate", "hover", *options)
    assert text.startswith("plant.step_s: 0.05 s is unstable with the stop_dissipation_s_rad of")
    assert text.endswith("allowed: at most 0.00785 s")


@pytest.mark.parametrize("command", ["run", "simulate"])
def test_an_unknown_scenario_lists_the_choices(capsys, command):
    assert error_of(capsys, command, "hoover") == (
        "unknown scenario 'hoover'; choose one of arm_swing, dive_and_work, grasp, hover,"
        " manipulation, manipulation_marker, swell, or a YAML file"
    )
    assert error_of(capsys, command, "no.yaml") == "scenario file 'no.yaml' does not exist"


@pytest.mark.parametrize("command", ["run", "simulate"])
def test_an_output_folder_that_holds_a_run_is_left_alone(capsys, tmp_path, command):
    log = tmp_path / "old" / "run.mcap"
    log.parent.mkdir()
    log.write_bytes(b"old")
    text = error_of(capsys, command, "hover", "--output", str(log.parent))
    assert text == f"{log.parent} holds a run already; give another --output, or remove it"
    assert [path.name for path in log.parent.iterdir()] == ["run.mcap"]
    assert log.read_bytes() == b"old"


def test_an_output_that_cannot_be_a_folder(capsys, tmp_path):
    (tmp_path / "file").write_text("x", encoding="utf-8")
    text = error_of(capsys, "simulate", "hover", "--output", "file/run")
    assert text == "--output file/run: Not a directory"


@pytest.mark.parametrize("command", [["report"], ["replay"], ["replay", "--into", "controller"]])
def test_a_missing_log(capsys, command):
    text = error_of(capsys, *command, "no.mcap")
    assert text == "log no.mcap: cannot be read: No such file or directory"


@pytest.mark.parametrize("command", ["report", "replay"])
def test_a_log_that_is_none(capsys, command):
    Path("log.mcap").write_text("not a log", encoding="utf-8")
    assert error_of(capsys, command, "log.mcap") == "log log.mcap: is not an MCAP file"


@pytest.mark.parametrize("rate", ["nan", "inf", "-1"])
def test_a_replay_rate_that_never_ends(capsys, rate):
    text = error_of(capsys, "replay", "no.mcap", "--rate", rate)
    assert text == f"--rate {rate}: choose 0 (as fast as possible) or a finite factor above"


def test_an_unknown_node_to_replay_into_lists_the_nodes(capsys):
    assert error_of(capsys, "replay", "no.mcap", "--into", "pilot") == (
        "--into 'pilot': choose one of plant, navigation, disturbance_observer, motion_planner,"
        " controller, thrust_allocator"
    )


@pytest.mark.parametrize(
    "arguments",
    [[], ["hover"], ["run"], ["simulate", "hover", "--seed", "x"], ["run", "hover", "--sed", "1"]],
)
def test_words_that_are_no_command_end_in_the_usage(capsys, arguments):
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    err = capsys.readouterr().err
    assert err.startswith("usage: uvms")
    assert err.count("error: ") == 1


@pytest.mark.parametrize("command", [[], *([name] for name in COMMANDS)])
def test_every_command_has_help(capsys, command):
    with pytest.raises(SystemExit) as end:
        main([*command, "--help"])
    assert end.value.code == 0
    text = capsys.readouterr().out
    assert text.startswith(" ".join(["usage: uvms", *command]))
    for name in COMMANDS if not command else ("--output",):
        assert name in text


def test_bringup_py_is_uvms_run():
    found = subprocess.run(
        [sys.executable, str(BRINGUP), "hover", "--help"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert found.stdout.startswith("usage: uvms run")


def test_simulate_says_which_options_have_no_effect_and_records_its_own_pace(capsys):
    options = ["--pace", "realtime:2", "--composed", "--duration", "0.1", "--output", "quick"]
    assert main(["simulate", "hover", *options]) == 0
    out, err = capsys.readouterr()
    assert "note: --pace realtime:2 and --composed: no effect on `uvms simulate`" in err
    assert json.loads(Path("quick/summary.json").read_text(encoding="utf-8"))["completed"]
    assert "log: " in out
    assert RunLog.open("quick/run.mcap").run["pace"] == "lockstep"


def test_simulate_says_nothing_of_options_that_are_not_given(capsys):
    options = ["--pace", "lockstep", "--duration", "0.1", "--output", "quick"]
    assert main(["simulate", "hover", *options]) == 0
    assert "note:" not in capsys.readouterr().err


OWN_COMMAND = """
from uvms_core.command import Command
from uvms_core.errors import UvmsError


def add_arguments(parser):
    parser.add_argument("depth", type=float)


def run(options):
    if options.depth < 0.0:
        raise UvmsError(f"depth {options.depth:g} m: choose at least 0")
    print(f"{options.command_line} at {options.depth:g} m")
    return 3


COMMAND = Command("go to a depth", add_arguments, run)
"""


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """Installs modules and entry points of commands as `pip install` would leave them."""

    def install(entries, **modules):
        place = tmp_path / "site"
        info = place / "own_commands-1.0.dist-info"
        info.mkdir(parents=True)
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: own_commands\nVersion: 1.0\n")
        (info / "entry_points.txt").write_text("\n".join(["[uvms.commands]", *entries]) + "\n")
        for name, text in modules.items():
            (place / f"{name}.py").write_text(text)
        monkeypatch.syspath_prepend(str(place))
        registry.refresh()

    yield install
    monkeypatch.undo()
    registry.refresh()


def help_text(capsys, *arguments):
    with pytest.raises(SystemExit) as end:
        main([*arguments, "--help"])
    assert end.value.code == 0
    return capsys.readouterr().out


def test_another_package_adds_a_command(capsys, installed):
    installed(["dive = own_dive:COMMAND"], own_dive=OWN_COMMAND)
    assert "go to a depth" in help_text(capsys)
    assert "Go to a depth." in help_text(capsys, "dive")
    assert main(["dive", "2.5"]) == 3
    assert capsys.readouterr().out == "uvms dive 2.5 at 2.5 m\n"
    assert error_of(capsys, "dive", "-1") == "depth -1 m: choose at least 0"


def test_a_command_that_cannot_be_imported_leaves_the_others_alone(capsys, installed):
    installed(["dive = own_missing:COMMAND"])
    text = " ".join(help_text(capsys).split())
    assert "dive (not available: command 'dive': cannot import own_missing:COMMAND" in text
    assert error_of(capsys, "report", "no.mcap").startswith("log no.mcap")
    assert error_of(capsys, "dive").startswith("command 'dive': cannot import own_missing")


def test_a_class_in_the_working_directory_is_found_and_its_mistake_is_one_line(capsys):
    """The folder of the test is the working directory; only there is a module `at_hand`."""
    Path("at_hand.py").write_text(
        "class Law:\n"
        "    def __init__(self, vehicle, config): pass\n"
        "    def step(self, odometry, joints, disturbance, reference): return None\n",
        encoding="utf-8",
    )
    assert main(["simulate", "hover", "--set", "control.law=at_hand:Law", "--output", "o"]) == 2
    err = capsys.readouterr().err
    assert "error: controller: its step failed at t = 0 s: TypeError: " in err
    assert "Traceback" not in err


def test_a_reader_that_leaves_early_ends_the_command_quietly():
    command = f"{sys.executable} -m uvms_bringup.cli fields | head -n 1"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert len(done.stdout.splitlines()) == 1
