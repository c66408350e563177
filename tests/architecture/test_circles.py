"""No module imports another that imports it, directly or by way of others."""

import ast
from graphlib import CycleError, TopologicalSorter

import pytest
from project import PACKAGES, modules


def name_of(package, file):
    parts = file.relative_to(PACKAGES[package]).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def statements(tree):
    """Import statements wherever they are, but for those that only type checkers see."""
    if isinstance(tree, ast.If) and "TYPE_CHECKING" in ast.dump(tree.test):
        return
    if isinstance(tree, ast.Import | ast.ImportFrom):
        yield tree
    for child in ast.iter_child_nodes(tree):
        yield from statements(child)


def imported(statement):
    """Names that a statement may import as modules."""
    if isinstance(statement, ast.Import):
        return [alias.name for alias in statement.names]
    names = [f"{statement.module}.{alias.name}" for alias in statement.names]
    return [statement.module, *names]


def graph(sources):
    """By module, the modules among the sources (name: text) that it imports."""
    edges = {}
    for name, text in sources.items():
        found = set()
        for statement in statements(ast.parse(text)):
            options = [one for one in imported(statement) if one in sources]
            # `from package import module` needs the module, not what else the package has.
            inner = [one for one in options if one != getattr(statement, "module", None)]
            found.update(inner or options)
        edges[name] = found - {name}
    return edges


def circle(edges):
    """Modules of some circle, in order; empty if there is none."""
    try:
        TopologicalSorter(edges).prepare()
    except CycleError as fault:
        return fault.args[1]
    return []


def test_there_is_no_circle_of_imports():
    sources = {
        name_of(package, file): file.read_text(encoding="utf-8")
        for package in PACKAGES
        for file in modules(package)
    }
    edges = graph(sources)
    assert sum(map(len, edges.values())) > 500
    assert circle(edges) == []


@pytest.mark.parametrize(
    ("second", "found"),
    [
        ("def f():\n    from p.one import x", True),  # as ros/feed and ros/replay once did
        ("import p.one", True),
        ("from p import one", True),
        ("from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from p.one import x", False),
        ("from p import other", False),
    ],
)
def test_a_circle_is_found(second, found):
    sources = {"p": "", "p.one": "from p.two import y", "p.two": second, "p.other": ""}
    assert (set(circle(graph(sources))) == {"p.one", "p.two"}) is found
