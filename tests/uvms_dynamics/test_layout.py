"""The flat tables of the kernels: no two columns of a row share a place."""

from itertools import pairwise

import numpy as np
import pytest

from uvms_dynamics.kernels import layout

ROWS = {
    "hull": (layout.BODY | layout.HULL_ONLY, layout.MODEL_COLUMNS),
    "link": (layout.BODY | layout.JOINT, layout.MODEL_COLUMNS),
    "fixtures": (layout.FIXTURES, layout.MODEL_COLUMNS),
    "cylinder": (layout.CYLINDER, sum(layout.CYLINDER.values())),
    "fin": (layout.FIN, layout.FIN_NUMBERS),
    "workspace": (layout.WORKSPACE, layout.WORK_COLUMNS),
}


@pytest.mark.parametrize("row", ROWS)
def test_columns_do_not_overlap_and_fit_into_the_row(row):
    """By the constants that the kernels use, whatever order they were unpacked in."""
    widths, columns = ROWS[row]
    places = sorted((getattr(layout, name), name, width) for name, width in widths.items())
    for (begin, name, width), (following, other, _) in pairwise(places):
        assert begin + width <= following, f"{name} reaches into {other}"
    first, (last, _, width) = places[0][0], places[-1]
    assert 0 <= first
    assert last + width <= columns


def test_every_column_is_an_int64_that_one_group_declares():
    """A literal int would be compiled anew in every call; a column outside a group is unchecked."""
    groups = (
        layout.BODY,
        layout.JOINT,
        layout.HULL_ONLY,
        layout.FIXTURES,
        layout.CYLINDER,
        layout.FIN,
        layout.WORKSPACE,
    )
    declared = [name for group in groups for name in group]
    assert len(set(declared)) == len(declared)
    others = {"FIRST", "HULL", "FIN_NUMBERS", "MODEL_COLUMNS", "WORK_COLUMNS"}
    numbers = {name for name, value in vars(layout).items() if isinstance(value, np.integer)}
    assert numbers == {*declared, *others}
    assert all(type(getattr(layout, name)) is np.int64 for name in numbers)
