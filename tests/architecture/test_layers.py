"""ROS stays in the shells, and packages depend downwards only."""

import pytest
from project import PACKAGES, ROOT, imports, is_ros, modules

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


HOUSEKEEPING = {"compile_cache.py"}  # clears away old machine code; computes nothing


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
