"""ROS stays in the shells, and packages depend downwards only."""

import ast

import pytest
from project import PACKAGES, ROOT, imports, is_ros, modules

from uvms_dynamics import _MOVED

SHELLS = {"nodes", "ros"}
# What a package may import besides itself; uvms_msgs is for its shells.
MAY_IMPORT = {
    "uvms_core": set(),
    "uvms_dynamics": {"uvms_core"},
    "uvms_observer": {"uvms_core", "uvms_dynamics"},
    "uvms_planner": {"uvms_core", "uvms_dynamics"},
    "uvms_control": {"uvms_core", "uvms_dynamics"},
    "uvms_analysis": {"uvms_core", "uvms_dynamics"},
    "uvms_bringup": set(PACKAGES),
}


@pytest.mark.parametrize("package", PACKAGES)
def test_only_nodes_and_ros_folders_import_ros(package):
    core = [file for file in modules(package) if not SHELLS & set(file.parts)]
    assert core
    leaks = {
        str(file.relative_to(ROOT)): sorted(filter(is_ros, imports(file)))
        for file in core
        if any(map(is_ros, imports(file)))
    }
    assert leaks == {}


@pytest.mark.parametrize("package", PACKAGES)
def test_packages_depend_downwards_only(package):
    own = set(PACKAGES) - MAY_IMPORT[package] - {package}
    upward = {
        str(file.relative_to(ROOT)): sorted(own.intersection(imports(file)))
        for file in modules(package)
        if own.intersection(imports(file))
    }
    assert upward == {}


TRUTH = "uvms_dynamics.simulation"
MAY_SIMULATE = {"uvms_analysis", "uvms_bringup"}


def simulation_imports(file):
    """Names by which a file gets at the simulated plant: its module, or an old name."""
    for statement in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(statement, ast.Import):
            names = [alias.name for alias in statement.names]
        elif isinstance(statement, ast.ImportFrom) and statement.module:
            names = [f"{statement.module}.{alias.name}" for alias in statement.names]
        else:
            continue
        yield from (name for name in names if name.startswith(TRUTH) or name in OLD_NAMES)


OLD_NAMES = {f"uvms_dynamics.{name}" for name, home in _MOVED.items() if home == TRUTH}


@pytest.mark.parametrize("package", sorted(set(PACKAGES) - MAY_SIMULATE))
def test_no_estimator_or_controller_reads_the_plants_truth(package):
    """Within dynamics the simulation itself and the plant's node may."""
    own = PACKAGES[package] / package
    inside = {"simulation", "nodes"} if package == "uvms_dynamics" else set()
    found = {
        str(file.relative_to(ROOT)): names
        for file in modules(package)
        if file.relative_to(own).parts[0] not in inside
        and (names := list(simulation_imports(file)))
    }
    assert found == {}


def test_the_wall_is_seen_through_every_door(tmp_path):
    file = tmp_path / "law.py"
    for text in (
        "import uvms_dynamics.simulation.plant",
        "from uvms_dynamics import simulation",
        "from uvms_dynamics.simulation import Plant",
        "def f():\n    from uvms_dynamics import Plant",
    ):
        file.write_text(text)
        assert len(list(simulation_imports(file))) == 1, text
    file.write_text("from uvms_dynamics import Model")
    assert list(simulation_imports(file)) == []


# Computes nothing: clears away old machine code; says when a message was recorded.
HOUSEKEEPING = {"compile_cache.py", "wall_clock.py"}


@pytest.mark.parametrize("package", PACKAGES)
def test_cores_use_no_global_random_state_and_no_clock(package):
    """Randomness and time are arguments, or runs could not be repeated."""
    if package == "uvms_bringup":
        forbidden = {"random"}
    else:
        forbidden = {"random", "time", "datetime"}
    core = [
        file
        for file in modules(package)
        if not SHELLS & set(file.parts) and file.name not in HOUSEKEEPING
    ]
    users = {
        str(file.relative_to(ROOT)): sorted(forbidden.intersection(imports(file)))
        for file in core
        if forbidden.intersection(imports(file))
    }
    assert users == {}
