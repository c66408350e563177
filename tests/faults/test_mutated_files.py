"""Damaged vehicle and scenario files: a clear error of ours, or a vehicle that moves finitely."""

import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from mutations import cases

from uvms_bringup.locate import known_scenarios
from uvms_bringup.scenario import load_scenario
from uvms_core.errors import UvmsError
from uvms_core.vehicle import load_vehicle, vehicle_warnings
from uvms_core.vehicle.locate import known_vehicles
from uvms_dynamics.simulation import Plant, PlantConfig

VEHICLES = [path.read_text(encoding="utf-8") for path in known_vehicles().values()]
SCENARIOS = [path.read_text(encoding="utf-8") for path in known_scenarios().values()]
FIRST_STEPS = 4


def assert_clear(fault: UvmsError) -> None:
    """Lines that a user can read: bounded in number, printable, no Python inside."""
    lines = str(fault).splitlines()
    assert 0 < len(lines) <= 60
    assert all(len(line) < 1000 for line in lines), max(lines, key=len)[:300]
    assert "Traceback" not in str(fault)
    assert "object at 0x" not in str(fault)


def assert_moves(plant: Plant) -> None:
    """The first steps, with the brakes engaged, are finite."""
    for _ in range(FIRST_STEPS):
        plant.step(None, None)
        truth = plant.truth()
        for values in (truth.odometry.position, truth.odometry.nu, truth.joints.position):
            assert np.isfinite(values).all()


def try_vehicle(path: Path) -> str:
    """What came of a vehicle file."""
    try:
        vehicle = load_vehicle(path)
        warnings = vehicle_warnings(vehicle)
        plant = Plant(vehicle, PlantConfig(initial_position_m=(0.0, 0.0, 10.0)), 1)
    except UvmsError as fault:
        assert_clear(fault)
        return type(fault).__name__
    assert_moves(plant)
    return "warned of" if warnings else "taken"


def try_scenario(path: Path) -> str:
    """What came of a scenario file, up to the first steps of its plant."""
    try:
        scenario = load_scenario(str(path))
        vehicle = scenario.load_vehicle()
        scenario = scenario.for_vehicle(vehicle)
        scenario.goal.build(vehicle, scenario.plant)
        plant = Plant(vehicle, scenario.plant, scenario.seed)
    except UvmsError as fault:
        assert_clear(fault)
        return type(fault).__name__
    assert_moves(plant)
    return "taken"


def outcomes(folder: Path, texts: list[str], attempt, count: int, seed: int) -> Counter:
    """How often each outcome came about."""
    found: Counter = Counter()
    for number, (what, raw) in enumerate(cases(texts, count, seed)):
        path = folder / f"mutated_{number}.yaml"
        path.write_bytes(raw)
        try:
            found[attempt(path)] += 1
        except Exception as fault:
            raise AssertionError(f"case {number} of seed {seed} ({what}): {fault!r}") from fault
    return found


def told(found: Counter) -> str:
    return ", ".join(f"{count} {name}" for name, count in found.most_common())


@pytest.mark.parametrize("kind", ["vehicle", "scenario"])
def test_a_few_damaged_files(kind, tmp_path):
    texts = {"vehicle": VEHICLES, "scenario": SCENARIOS}[kind]
    attempt = {"vehicle": try_vehicle, "scenario": try_scenario}[kind]
    found = outcomes(tmp_path, texts, attempt, 30, seed=1)
    assert 0 < found["taken"] < 30


@pytest.mark.long
@pytest.mark.parametrize("kind", ["vehicle", "scenario"])
def test_500_damaged_files(kind, tmp_path, saw):
    texts = {"vehicle": VEHICLES, "scenario": SCENARIOS}[kind]
    attempt = {"vehicle": try_vehicle, "scenario": try_scenario}[kind]
    found = outcomes(tmp_path, texts, attempt, 500, seed=2)
    assert found["taken"] < 500
    saw(f"damaged {kind} files", f"an error of ours or a finite motion: {told(found)}", "500")


@pytest.mark.parametrize("kind", ["vehicle", "scenario"])
def test_damaged_files_on_the_command_line(kind, tmp_path):
    """The real command: exit code 0 or 2, and never a traceback."""
    texts = {"vehicle": VEHICLES, "scenario": SCENARIOS}[kind]
    for number, (what, raw) in enumerate(cases(texts, 4, seed=3)):
        path = tmp_path / f"mutated_{number}.yaml"
        path.write_bytes(raw)
        command = {
            "vehicle": ["vehicle", str(path)],
            "scenario": ["simulate", str(path), "--duration", "0.1", "--output", f"run_{number}"],
        }[kind]
        done = subprocess.run(
            [sys.executable, "-m", "uvms_bringup.cli", *command],
            capture_output=True,
            text=True,
            cwd=tmp_path,
            check=False,
        )
        assert "Traceback" not in done.stderr, what
        assert done.returncode in (0, 1, 2), (what, done.stderr)
        assert done.returncode != 2 or "error: " in done.stderr
