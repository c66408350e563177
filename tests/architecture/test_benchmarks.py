"""`make bench`: the format of its output, without measuring much."""

import json
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from project import ROOT

from uvms_dynamics import build_model, forward_dynamics, mass_matrix

PROGRAM = ROOT / "benchmarks" / "run.py"
KEYS = ["name", "value", "unit", "reference", "ratio", "target", "met"]


def bench(*arguments):
    return subprocess.run(
        [sys.executable, str(PROGRAM), *arguments],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


@pytest.fixture
def module(monkeypatch):
    """Imports a module of the benchmarks, which are not a package; all are unloaded afterwards."""
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    yield import_module
    own = {path.stem for path in PROGRAM.parent.glob("*.py")} | {"cases"}
    for name in [name for name in sys.modules if name.split(".")[0] in own]:
        del sys.modules[name]


@pytest.fixture
def metrics(module):
    return module("metrics")


def test_list_shows_what_every_file_measures():
    done = bench("--list")
    assert done.returncode == 0, done.stderr
    listed = {line.split()[0] for line in done.stdout.splitlines()}
    assert listed == {path.stem for path in (PROGRAM.parent / "cases").glob("[!_]*.py")}
    assert all(len(line.split()) > 4 for line in done.stdout.splitlines())


def test_unknown_names_are_refused_with_the_choices():
    done = bench("allocation", "speed")
    assert done.returncode == 2
    assert done.stdout == ""
    assert "unknown: speed; choose from allocation, arm_swing" in done.stderr


@pytest.mark.parametrize("name", ["plant", "chain_mujoco"])
def test_every_line_is_one_object_with_the_agreed_keys(name):
    done = bench(name)
    assert done.returncode == 0, done.stderr
    found = [json.loads(line) for line in done.stdout.splitlines()]
    assert found
    assert all(list(metric) == KEYS for metric in found)
    assert all(metric["met"] in (True, False, None) for metric in found)


@pytest.mark.parametrize(
    ("field", "sign", "bound", "met"),
    [("ratio", ">=", 2.0, True), ("ratio", ">=", 2.1, False), ("value", "<=", 4.0, False)],
)
def test_targets_are_judged_by_the_field_that_they_name(metrics, field, sign, bound, met):
    target = metrics.Target(field, sign, bound)
    line = metrics.Metric("a", 5.0, "us", "b", 2.0, target).line()
    assert json.loads(line)["met"] is met
    assert json.loads(line)["target"] == f"{field} {sign} {bound:g}"


def test_what_was_not_measured_meets_no_target(metrics):
    line = metrics.Metric("a", 5.0, "us", target=metrics.Target("ratio", ">=", 0.0)).line()
    assert json.loads(line)["met"] is False


def test_a_ratio_is_our_time_over_theirs(module, monkeypatch):
    paired, now = module("paired"), [0.0]
    monkeypatch.setattr(paired.time, "perf_counter", lambda: now[0])

    def takes(seconds):
        def work():
            now[0] += seconds

        return work

    timing = paired.paired(takes(0.001), {"slow": takes(0.004), "quick": takes(0.0005)}, rounds=3)
    assert timing.seconds == pytest.approx(0.001)
    assert timing.ratio == pytest.approx({"slow": 0.25, "quick": 2.0})


@pytest.mark.parametrize("n", [1, 4, 8, 16, 32])
def test_all_engines_have_the_same_rigid_chain(module, n):
    """MuJoCo from our MJCF, Pinocchio, and our kernel without water, in random motion."""
    chains, mujoco_chain = module("chains"), module("mujoco_chain")
    vehicle, motions = chains.chain(n), module("motions").motions(n, count=4, seed=n)
    expected = module("rigid").Aba(vehicle, motions).results()
    theirs = mujoco_chain.mujoco_model(vehicle, 0.005, water=False)
    ours = build_model(chains.without_water(vehicle))
    for m, wanted in zip(motions, expected, strict=True):
        arguments = (m.quat, m.nu, m.q, m.q_dot, m.tau)
        limits = {"rtol": 1e-8, "atol": 1e-8 * np.abs(wanted).max()}
        found = mujoco_chain.mujoco_acceleration(theirs, *arguments)
        np.testing.assert_allclose(found, wanted, **limits)
        np.testing.assert_allclose(forward_dynamics(ours, *arguments), wanted, **limits)


@pytest.mark.parametrize("fluid", ["inertia_box", "ellipsoid"])
def test_mujocos_fluid_opposes_every_motion(module, fluid):
    chains, mujoco_chain = module("chains"), module("mujoco_chain")
    vehicle, motions = chains.chain(4), module("motions").motions(4, count=4)
    wet, dry = (
        mujoco_chain.mujoco_model(vehicle, 0.005, water=water, fluid=fluid)
        for water in (True, False)
    )
    mass = mass_matrix(build_model(chains.without_water(vehicle)), motions[0].q)
    for m in motions:
        arguments = (m.quat, m.nu, motions[0].q, m.q_dot, m.tau)
        added = mujoco_chain.mujoco_acceleration(wet, *arguments)
        added -= mujoco_chain.mujoco_acceleration(dry, *arguments)
        assert np.concatenate([m.nu, m.q_dot]) @ mass @ added < -0.1


def test_chains_have_full_hydrodynamics(module):
    for n in (4, 32):
        vehicle = module("chains").chain(n)
        for body in (vehicle.hull, *vehicle.arm.links):
            matrix = np.array(body.added_mass)
            assert np.all(matrix != 0.0)
            assert np.linalg.eigvalsh(matrix)[0] > 0.0
        cylinders = [cylinder for link in vehicle.arm.links for cylinder in link.drag]
        assert sum(cylinder.stations for cylinder in cylinders) == 3 * n


def test_simulated_chains_stay_slow_and_do_not_depend_on_the_step(module):
    """What is timed is an ordinary swimming motion, resolved by its step, not a diverging one."""
    compiled, chains = module("compiled"), module("chains")
    motion = module("motions").slow_motion(16)
    state = compiled.stepping(chains.chain(16), motion)().copy()
    fine = compiled.stepping(chains.chain(16), motion, halvings=1)().copy()
    assert np.max(np.abs(state)) < 2.0
    np.testing.assert_allclose(state, fine, atol=1e-6)
