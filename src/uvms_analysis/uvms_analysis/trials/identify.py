"""`uvms identify`: fit the constants that the trials determine, and refuse the others."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from uvms_analysis.errors import TrialError
from uvms_analysis.trials.fit import PRECISION, Fit, fit
from uvms_analysis.trials.parameters import CANDIDATES, Parameter, present, value_at
from uvms_analysis.trials.predict import PreparedTrial, drive_model, prepare_trial
from uvms_analysis.trials.read import read_trials
from uvms_analysis.trials.rewrite import rewritten
from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import vehicle_from_data
from uvms_core.yaml_text import read_yaml

SIGNIFICANCE = 2.0
"""Standard errors by which a constant that may be absent must differ from zero."""

MIN_MOTIONS = 5
"""Motions that a jackknife needs for trustworthy errors; with fewer the report warns."""

COARSE_PRECISION = 1e-3
"""Precision of fits that only find out which constants are not determined."""

INSEPARABLE = 0.92
"""Correlation of two errors above which the trials determine only their combination."""

Log = Callable[[str], None]


@dataclass
class Identified:
    """Fitted constants, and the refused ones with the reason."""

    data: Any  # of the vehicle file, before the fit
    fit: Fit
    refused: dict[str, str] = field(default_factory=dict)

    @property
    def values(self) -> dict[str, tuple[float, float]]:
        """The identified numbers and their standard errors, by path in the file."""
        rows = zip(self.fit.parameters, self.fit.values, self.fit.errors, strict=True)
        return {parameter.path: (float(value), float(error)) for parameter, value, error in rows}


def identify(
    data: Any,
    prepared: Sequence[PreparedTrial],
    log: Log = lambda line: None,
    candidates: Sequence[Parameter] | None = None,
) -> Identified:
    """Fit all candidates; while one is not determined, drop the worst and fit the others.

    Raises:
        TrialError: there are fewer than three trials, or they determine nothing at all.
    """
    parameters, refused = present(data, candidates or CANDIDATES)
    precision = COARSE_PRECISION
    while parameters:
        log(f"fitting {len(parameters)} constants to {len(prepared)} trials")
        found = fit(data, prepared, parameters, log, precision)
        worst, reason = _worst(found)
        if worst is not None:
            log(f"giving up {worst.name}: {reason}")
            refused[worst.name] = reason
            parameters = [p for p in parameters if p is not worst]
        elif precision == COARSE_PRECISION:
            precision = PRECISION
        else:
            return Identified(data, found, refused)
    reasons = "\n".join(f"  {name}: {reason}" for name, reason in refused.items())
    raise TrialError(f"these trials determine none of the constants:\n{reasons}")


def _worst(found: Fit) -> tuple[Parameter | None, str]:
    """The least determined parameter with the reason, if any is not determined well enough."""
    spread = found.errors / np.array([p.worst_error for p in found.parameters])
    k = int(np.argmax(spread))
    parameter, error = found.parameters[k], found.errors[k]
    if spread[k] > 1.0:
        unit = parameter.unit
        return parameter, f"standard error {error:.2g} {unit}; at most {parameter.worst_error:g}"
    for p, value, error in zip(found.parameters, found.values, found.errors, strict=True):
        if p.may_be_absent and abs(value) < SIGNIFICANCE * error:
            return (
                p,
                f"{value:.2g} +- {error:.2g} {p.unit} does not differ significantly from 0",
            )
    together = np.abs(np.triu(found.correlation, 1))
    i, j = divmod(int(np.argmax(together)), len(together))
    if together[i, j] > INSEPARABLE:
        k, other = (i, j) if spread[i] > spread[j] else (j, i)
        name = found.parameters[other].name
        return found.parameters[
            k
        ], f"cannot be separated from {name} (correlation {together[i, j]:.2f})"
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
            line += f"  (correlated with {found.fit.parameters[other].name}:"
            line += f" {found.fit.correlation[k, other]:+.2f})"
        lines.append(line)
    lines += [f"not fitted: {name}: {reason}. The file's value stays."
              for name, reason in found.refused.items()]  # fmt: skip
    return "\n".join([*lines, *_footing(found.fit)])


def _footing(fit: Fit) -> list[str]:
    """How well the model follows the trials, and how many motions the standard errors rest on."""
    roll, pitch = fit.median_deg
    lines = [
        f"root mean square of roll and pitch over all samples, each trial weighted equally:"
        f" {fit.rms_deg:.3f} deg",
        f"median of the trials' RMSE: roll {roll:.3f} deg, pitch {pitch:.3f} deg",
        f"standard errors: jackknife over {fit.groups} motions (repeats NAME-0, NAME-1 are one;"
        " trials, if there are fewer than 3 motions)",
    ]
    if fit.groups < MIN_MOTIONS:
        lines.append(
            f"warning: {fit.groups} motions are too few for these errors: the true error of a"
            f" constant may be many times larger. Record at least {MIN_MOTIONS} different motions"
        )
    return lines


def prepared_trials(folder: str, log: Log = lambda line: None) -> list[PreparedTrial]:
    """The folder's trials, prepared for prediction."""
    return [prepare_trial(trial) for trial in read_trials(folder, log)]


def check_output(vehicle: str, output: str) -> None:
    """Raise TrialError if the vehicle file itself would be overwritten."""
    if Path(output).resolve() == Path(vehicle).resolve():
        raise TrialError(
            f"--output {output} is the vehicle file itself; name another file, then compare the two"
        )


def identify_file(trials: str, vehicle: str, log: Log) -> tuple[Identified, list[PreparedTrial]]:
    """Identify the constants of a vehicle file from a folder of trials."""
    data = read_yaml(Path(vehicle), vehicle, VehicleFileError)
    described = vehicle_from_data(data, vehicle)  # fails early, naming the file
    prepared = prepared_trials(trials, log)
    drive_model(described)  # refuses a different arm
    return identify(data, prepared, log), prepared


def write(found: Identified, vehicle: str, output: str) -> Path:
    """Write the vehicle file with the identified numbers, its comments kept."""
    text = rewritten(Path(vehicle).read_text(encoding="utf-8"), found.values)
    target = Path(output)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text, encoding="utf-8")
    return target
