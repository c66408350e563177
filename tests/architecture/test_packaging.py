"""The packages describe themselves alike to ROS and to pip, and what they promise is there."""

import ast
import re
from collections import Counter
from configparser import ConfigParser

import pytest
from project import (
    CODE,
    INTERFACES,
    PACKAGES,
    ROOT,
    imports,
    is_ros,
    manifest,
    modules,
    python_files,
    required,
    setup_arguments,
)

LONGEST = 400
EXECUTABLES = {
    "uvms_core": set(),
    "uvms_dynamics": {"plant"},
    "uvms_observer": {"navigation", "disturbance_observer"},
    "uvms_planner": {"motion_planner"},
    "uvms_control": {"controller", "thrust_allocator"},
    "uvms_analysis": set(),
    "uvms_bringup": {"uvms", "state_publisher"},
}


def test_all_packages_have_one_version():
    versions = {folder.name: manifest(folder).findtext("version") for folder in PACKAGES.values()}
    versions["uvms_msgs"] = manifest(INTERFACES).findtext("version")
    versions |= {
        f"{folder.name}/setup.py": setup_arguments(folder)["version"]
        for folder in PACKAGES.values()
    }
    assert len(set(versions.values())) == 1, versions


@pytest.mark.parametrize(("package", "folder"), PACKAGES.items())
def test_manifest_and_setup_agree(package, folder):
    xml, arguments = manifest(folder), setup_arguments(folder)
    assert xml.findtext("name") == package
    assert xml.findtext("description") == arguments["description"]
    assert xml.findtext("license") == arguments["license"] == "Apache-2.0"
    assert xml.findtext("export/build_type") == "ament_python"
    assert (folder / "resource" / package).is_file()
    assert f"install_scripts=$base/lib/{package}" in (folder / "setup.cfg").read_text()


@pytest.mark.parametrize(("package", "folder"), PACKAGES.items())
def test_executables_name_modules_that_have_a_main(package, folder):
    scripts = dict(
        entry.split(" = ")
        for entry in setup_arguments(folder)["entry_points"].get("console_scripts", [])
    )
    assert set(scripts) == EXECUTABLES[package]
    for target in scripts.values():
        module, function = target.split(":")
        source = (folder / module.replace(".", "/")).with_suffix(".py")
        defined = {
            node.name for node in ast.parse(source.read_text()).body if hasattr(node, "name")
        }
        assert function in defined, f"{source} has no {function}()"


@pytest.mark.parametrize(("package", "folder"), PACKAGES.items())
def test_manifest_names_every_ros_package_that_the_code_imports(package, folder):
    named = {item.text for item in manifest(folder).iter() if item.tag.endswith("depend")}
    ros = {
        name
        for file in modules(package)
        for name in imports(file)
        if is_ros(name) or name.startswith("uvms_")
    }
    assert ros - {package} <= named


@pytest.mark.parametrize("package", PACKAGES)
def test_every_folder_with_code_is_a_package(package):
    """find_packages skips folders without __init__.py, and an installation would lack them."""
    folders = {file.parent for file in modules(package)}
    assert [str(folder) for folder in folders if not (folder / "__init__.py").is_file()] == []


@pytest.mark.parametrize(("package", "folder"), PACKAGES.items())
def test_colcon_test_finds_the_tests(package, folder):
    """It starts pytest where the extra `test` names it, in the package's folder."""
    parser = ConfigParser()
    parser.read(folder / "setup.cfg")
    place = folder / parser["tool:pytest"]["testpaths"]
    assert place.resolve() == ROOT / "tests" / package
    assert list(place.glob("test_*.py"))
    assert "pytest" in required(package, "test")


def test_addresses_are_no_placeholders():
    """The format of a manifest wants an address; it may not look like a person's."""
    texts = {
        path: path.read_text(encoding="utf-8")
        for pattern in ("src/*/package.xml", "src/*/setup.py", "bringup/*.xml", "bringup/setup.py",
                        "tools/*/package.xml", "*.md", "*.toml", "*.cff")
        for path in ROOT.glob(pattern)
    }  # fmt: skip
    assert len(texts) > 15
    found = {
        address for text in texts.values() for address in re.findall(r"[\w.+-]+@[\w.-]+", text)
    }
    assert found <= {"noreply@github.com"}


HOLDS_ONE_THING = {"checks", "config", "errors", "gate", "helpers", "types", "utils"}


@pytest.mark.parametrize("package", PACKAGES)
def test_general_names_occur_once_in_a_package(package):
    """Else a file's name does not say what it holds."""
    names = Counter(file.stem for file in modules(package) if file.stem in HOLDS_ONE_THING)
    assert {name: count for name, count in names.items() if count > 1} == {}


def test_files_stay_short():
    lengths = {
        str(file.relative_to(ROOT)): len(file.read_text(encoding="utf-8").splitlines())
        for file in python_files()
    }
    assert len(lengths) > 30, CODE
    assert {name: length for name, length in lengths.items() if length >= LONGEST} == {}
