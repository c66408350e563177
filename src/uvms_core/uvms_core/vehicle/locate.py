"""Finds vehicle files: those of this package by name, others by path."""

from pathlib import Path

from uvms_core.errors import VehicleFileError

REFERENCE = "reference_auv"
FILE_SUFFIXES = (".yaml", ".yml")
_FOLDER = Path(__file__).resolve().parents[1] / "vehicles"


def known_vehicles() -> dict[str, Path]:
    """Vehicles that come with the project, by name."""
    return {path.stem: path for path in sorted(_FOLDER.glob("*.yaml"))}


def reference_file() -> Path:
    """File of the reference vehicle."""
    return vehicle_path(REFERENCE)


def vehicle_path(name: str | Path, folder: Path | None = None) -> Path:
    """The file of a vehicle of this project by its name, or the YAML file at the path `name`.

    A relative path starts at `folder` (None: the working directory).

    Raises:
        VehicleFileError: for a name that is neither; lists the choices.
    """
    path = Path(name)
    if path.suffix in FILE_SUFFIXES:
        return path if folder is None else folder / path
    known = known_vehicles()
    if str(name) not in known:
        choices = ", ".join(known)
        raise VehicleFileError(
            f"unknown vehicle {str(name)!r}; choose one of {choices}, or a YAML file"
        )
    return known[str(name)]
