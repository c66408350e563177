"""Vehicle files that are copies of another vehicle: of another size, or with other sections.

name: my_auv
copy: {of: reference_auv, mass: 10.0}   # ten times as heavy, all lengths times 10^(1/3)
thrusters: [...]                         # a section that is given here takes the copy's place
"""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import Field

from uvms_core.config import Config, validated
from uvms_core.errors import VehicleFileError
from uvms_core.vehicle.locate import FILE_SUFFIXES, vehicle_path
from uvms_core.vehicle.scaled import scaled_data
from uvms_core.yaml_text import read_yaml

SECTION = "copy"
Complete = Callable[[Any, str], dict[str, Any]]
"""Makes the plain data of a vehicle file complete: no keyword is left."""


class Copy(Config):
    """What a vehicle file is a copy of."""

    of: str = Field(min_length=1, description="name of a vehicle of the project, or a vehicle file")
    mass: float = Field(
        1.0,
        gt=0.0,
        le=1e4,
        description="factor on all masses: lengths go with its cube root, and all else with them",
    )


def is_copy(data: Any) -> bool:
    """Whether plain data of a vehicle file says that it is one."""
    return isinstance(data, dict) and SECTION in data


def with_path_from(data: Any, folder: Path) -> Any:
    """The data, with the file that it is a copy of found from the folder of its own file."""
    if not is_copy(data) or not isinstance(data[SECTION], dict):
        return data
    of = data[SECTION].get("of")
    if not isinstance(of, str) or not of.endswith(FILE_SUFFIXES):
        return data
    return {**data, SECTION: {**data[SECTION], "of": str((folder / of).resolve())}}


def copied(data: Any, what: str, complete: Complete) -> Any:
    """Plain data of a vehicle file without its section `copy`: what it is a copy of, changed.

    Raises:
        VehicleFileError: there is no such vehicle, or it is a copy itself.
    """
    if not is_copy(data):
        return data
    own = {name: value for name, value in data.items() if name != SECTION}
    wanted = validated(Copy, data[SECTION], f"{what}: {SECTION}", VehicleFileError)
    try:
        path = vehicle_path(wanted.of)
    except VehicleFileError as fault:
        raise VehicleFileError(f"{what}: {SECTION}.of: {fault}") from fault
    original = read_yaml(path, str(path), VehicleFileError)
    if is_copy(original):
        raise VehicleFileError(
            f"{what}: {SECTION}.of: {wanted.of} is a copy itself, of {original[SECTION]}; copy that"
        )
    if wanted.mass != 1.0:  # keywords stay where nothing is scaled
        original = scaled_data(complete(original, str(path)), math.cbrt(wanted.mass))
    return {**original, **own} if isinstance(original, dict) else original
