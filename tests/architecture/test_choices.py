"""Parts are chosen by the registry alone: no other code compares the name of a method."""

import ast

import pytest
from project import PACKAGES, ROOT, modules

CHOICES = {
    "method",
    "law",
    "filter",
    "filter_name",
    "observer",
    "planner",
    "controller",
    "allocator",
}
REGISTRY = PACKAGES["uvms_core"] / "uvms_core" / "registry.py"


def is_choice(node):
    """Whether an expression is the name of a chosen part: `method`, `config.method`."""
    name = getattr(node, "attr", getattr(node, "id", ""))
    return name in CHOICES


def is_text(node):
    if isinstance(node, ast.Tuple | ast.List | ast.Set):
        return any(map(is_text, node.elts))
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def chooses(node):
    """Whether a node picks code by the name of a part."""
    if isinstance(node, ast.Compare):
        sides = [node.left, *node.comparators]
        return any(map(is_choice, sides)) and any(map(is_text, sides))
    if isinstance(node, ast.Match):
        return is_choice(node.subject)
    # A table of methods: {"genetic": ...}[config.method].
    return isinstance(node, ast.Subscript) and is_choice(node.slice)


def lines(text):
    return [node.lineno for node in ast.walk(ast.parse(text)) if chooses(node)]


@pytest.mark.parametrize("package", PACKAGES)
def test_no_code_but_the_registry_compares_names_of_methods(package):
    found = {
        str(file.relative_to(ROOT)): lines(file.read_text(encoding="utf-8"))
        for file in modules(package)
        if file != REGISTRY
    }
    assert {name: numbers for name, numbers in found.items() if numbers} == {}


@pytest.mark.parametrize(
    "text",
    [
        "config.method == 'genetic'",
        "'genetic' != method",
        "self.config.law in ('s_surface', 'pid')",
        "match config.method:\n    case 'genetic':\n        pass",
        "{'genetic': 1}[config.method]",
    ],
)
def test_a_comparison_is_found(text):
    assert lines(text) == [1]


@pytest.mark.parametrize("text", ["method is None", "kind == 'path'", "load(PLANNERS, method)"])
def test_other_code_is_not(text):
    assert lines(text) == []
