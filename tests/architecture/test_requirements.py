"""A package requires exactly what its code imports, for pip and for ROS alike."""

import ast
import sys

import pytest
from project import DISTRIBUTIONS, PACKAGES, ROOT, imports, is_ros, manifest, modules, required


def optional_imports(file):
    """Names given to `optional`, which imports the libraries of an extra where they are used."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "optional":
            yield from (one.value for one in node.args if isinstance(one, ast.Constant))


def distributions(names):
    """What must be installed so that these can be imported, besides Python and ROS."""
    outside = {name for name in names if name not in sys.stdlib_module_names and not is_ros(name)}
    return {DISTRIBUTIONS.get(name, name) for name in outside}


@pytest.mark.parametrize("package", PACKAGES)
def test_setup_requires_what_the_code_imports_and_no_more(package):
    files = modules(package)
    names = {name for file in files for name in (*imports(file), *optional_imports(file))}
    wanted = distributions(names) - {package}
    extras = required(package, "panels") - set(PACKAGES)
    assert required(package) <= wanted
    assert wanted == required(package) | extras


@pytest.mark.parametrize(("package", "folder"), PACKAGES.items())
def test_manifest_and_setup_require_the_same(package, folder):
    """Packages of the project, and libraries that ROS's own package list has new enough."""
    keys = {"matplotlib", "numpy", "PyYAML", "ruamel.yaml", "scipy"}
    named = {item.text for item in manifest(folder).iter("exec_depend")}
    ours = named.intersection(PACKAGES)
    theirs = {key for key in keys if f"python3-{key.lower().removeprefix('py')}" in named}
    wanted = required(package) | required(package, "panels") - {"uvms_dynamics"}
    assert ours == wanted.intersection(PACKAGES)
    assert theirs == wanted & keys


@pytest.mark.parametrize("package", PACKAGES)
def test_the_extra_of_the_tests_has_what_they_import(package):
    """Besides what the package, and those below it, require."""
    own = {file.stem for file in (ROOT / "tests").rglob("*.py")}
    names = {name for file in (ROOT / "tests" / package).glob("*.py") for name in imports(file)}
    below = set().union(*map(required, required(package).intersection(PACKAGES) | {package}))
    extra = required(package, "test")
    if package in extra:  # as `package[panels]`
        extra |= required("uvms_dynamics", "panels")
    missing = distributions(names - own) - below - extra - set(PACKAGES)
    assert missing == set()
    assert extra - set(PACKAGES) - required("uvms_dynamics", "panels") <= distributions(names)
