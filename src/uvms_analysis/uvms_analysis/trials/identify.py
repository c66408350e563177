"""`uvms identify`: fit what the trials determine, and refuse the rest."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from uvms_analysis.errors import TrialError
from uvms_analysis.trials.fit import PRECISION, Fit, fit
from uvms_analysis.trials.parameters import CANDIDATES, Parameter, present, value_at
from uvms_analysis.trials.predict import Course, drive_model, make_course
from uvms_analysis.trials.read import read_trials
from uvms_analysis.trials.rewrite import rewritten
from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import vehicle_from_data
from uvms_core.yaml_text import read_yaml

SIGNIFICANCE = 2.0
"""Standard errors by which a thing that may be absent must differ from nothing."""

FEW_MOTIONS = 5
"""Motions below which the scatter of fits without one of them is no measure of the error."""

ROUGH = 1e-3
"""Precision of a fit that is to show only what is not determined."""

INSEPARABLE = 0.92
"""Correlation of two errors above which the trials show one combination and not both."""

Tell = Callable[[str], None]


@dataclass
class Identified:
    """What was fitted, and what was not and why."""

    data: Any  # of the vehicle file, as it was
    fit: Fit
    refused: dict[str, str] = field(default_factory=dict)

    @property
    def values(self) -> dict[str, tuple[float, float]]:
        """The identified numbers and their standard errors, by path in the file."""
        rows = zip(self.fit.parameters, self.fit.values, self.fit.errors, strict=True)
        return {parameter.path: (float(value), float(error)) for parameter, value, error in rows}


def identify(
    data: Any,
    courses: Sequence[Course],
    tell: Tell = lambda line: None,
    candidates: Sequence[Parameter] | None = None,
) -> Identified:
    """Fit all candidates; while one is not determined, give up the worst and fit the others.

    Raises:
        TrialError: there are fewer than three trials, or they determine nothing at all.
    """
    parameters, refused = present(data, candidates or CANDIDATES)
    precision = ROUGH
    while parameters:
        tell(f"fitting {len(parameters)} constants to {len(courses)} trials")
        found = fit(data, courses, parameters, tell, precision)
        worst, reason = _worst(found)
        if worst is not None:
            tell(f"giving up {worst.name}: {reason}")
            refused[worst.name] = reason
            parameters = [p for p in parameters if p is not worst]
        elif precision == ROUGH:
            precision = PRECISION
        else:
            return Identified(data, found, refused)
    reasons = "\n".join(f"  {name}: {reason}" for name, reason in refused.items())
    raise TrialError(f"these trials determine none of the constants:\n{reasons}")


def _worst(found: Fit) -> tuple[Parameter | None, str]:
    """The parameter that is determined least, if any is not well enough, and why."""
    spread = found.errors / np.array([p.worst_error for p in found.parameters])
    k = int(np.argmax(spread))
    parameter, error = found.parameters[k], found.errors[k]
    if spread[k] > 1.0:
        unit = parameter.unit
        return parameter, f"standard error {error:.2g} {unit}; at most {parameter.worst_error:g}"
    for p, value, error in zip(found.parameters, found.values, found.errors, strict=True):
        if p.may_be_absent and abs(value) < SIGNIFICANCE * error:
            return p, f"{value:.2g} +- {error:.2g} {p.unit} may as well be none"
    together = np.abs(np.triu(found.correlation, 1))
    i, j = divmod(int(np.argmax(together)), len(together))
    if together[i, j] > INSEPARABLE:
        k, other = (i, j) if spread[i] > spread[j] else (j, i)
        name = found.parameters[other].name
        return found.parameters[k], f"cannot be told from {name} (correlation {together[i, j]:.2f})"
    return None, ""


def report(found: Identified) -> str:
    """Table of the identified constants with errors, and the refused ones with reasons."""
    lines = [f"{'constant':<30}{'file':>12}{'identified':>12}{'std error':>11}  unit"]
    correlation = np.abs(found.fit.correlation) - np.eye(len(found.fit.parameters))
    for k, p in enumerate(found.fit.parameters):
        old, new, error = value_at(found.data, p.path), found.fit.values[k], found.fit.errors[k]
        line = f"{p.name:<30}{old:>12.5g}{new:>12.5g}{error:>11.2g}  {p.unit}"
        other = int(np.argmax(correlation[k]))
        if correlation[k, other] > 0.8:
            line += f"  (goes with {found.fit.parameters[other].name}:"
            line += f" {found.fit.correlation[k, other]:+.2f})"
        lines.append(line)
    lines += [f"not fitted: {name}: {reason}. The file's value stays."
              for name, reason in found.refused.items()]  # fmt: skip
    return "\n".join([*lines, *_footing(found.fit)])


def _footing(fit: Fit) -> list[str]:
    """How well the model follows the trials, and how much the standard errors rest on."""
    roll, pitch = fit.median_deg
    lines = [
        f"root mean square of roll and pitch over all samples, trials weighted alike:"
        f" {fit.rms_deg:.3f} deg",
        f"median of the trials' RMSE: roll {roll:.3f} deg, pitch {pitch:.3f} deg",
        f"standard errors: jackknife over {fit.groups} motions (repeats NAME-0, NAME-1 are one;"
        " trials, if there are fewer than 3 motions)",
    ]
    if fit.groups < FEW_MOTIONS:
        lines.append(
            f"warning: {fit.groups} motions are too few for these errors: what a constant is off by"
            f" may be many times its std error. Record at least {FEW_MOTIONS}, all different"
        )
    return lines


def courses_of(folder: str, tell: Tell = lambda line: None) -> list[Course]:
    """The folder's trials, ready to be driven."""
    return [make_course(trial) for trial in read_trials(folder, tell)]


def check_output(vehicle: str, output: str) -> None:
    """Raise TrialError if the vehicle file itself would be written over."""
    if Path(output).resolve() == Path(vehicle).resolve():
        raise TrialError(
            f"--output {output} is the vehicle file itself; name another file, then compare the two"
        )


def identify_file(trials: str, vehicle: str, tell: Tell) -> tuple[Identified, list[Course]]:
    """Identify the constants of a vehicle file from a folder of trials."""
    data = read_yaml(Path(vehicle), vehicle, VehicleFileError)
    described = vehicle_from_data(data, vehicle)  # its errors name the file, before the work
    courses = courses_of(trials, tell)
    drive_model(described)  # refuses another arm
    return identify(data, courses, tell), courses


def write(found: Identified, vehicle: str, output: str) -> Path:
    """The vehicle file with the identified numbers in it, comments and all."""
    text = rewritten(Path(vehicle).read_text(encoding="utf-8"), found.values)
    target = Path(output)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text, encoding="utf-8")
    return target
