"""`uvms validate`: compare the model with recorded trials."""

from collections.abc import Iterator
from pathlib import Path

from uvms_analysis.trials.navigate import Navigated, is_installed, navigate, navigated_vehicle
from uvms_analysis.trials.navigation_table import navigation_text
from uvms_analysis.trials.outcome import CONSTANT, DYNAMIC, QUASI_STATIC, Outcome, table
from uvms_analysis.trials.predict import (
    constant,
    drive_model,
    dynamic,
    prepare_trial,
    quasi_static,
)
from uvms_analysis.trials.read import INERTIAL, Log, Trial, read_trials
from uvms_analysis.trials.score import AXES, medians
from uvms_analysis.trials.table import Scores, table_text, write_csv
from uvms_analysis.trials.unit import unit_text
from uvms_core.vehicle import Vehicle, load_vehicle


def outcomes(vehicle: Vehicle, trials: list[Trial], trim: bool = True) -> Iterator[Outcome]:
    """Every trial in turn, predicted by the full model and by the simple ones."""
    model, load = drive_model(vehicle)
    for trial in trials:
        prepared = prepare_trial(trial)
        moving = dynamic(prepared, model, load, trim)
        still = quasi_static(prepared, model, load, moving.depth)
        yield Outcome(trial, {DYNAMIC: moving, QUASI_STATIC: still, CONSTANT: constant(prepared)})


def remarks(rows: Scores) -> list[str]:
    """Warnings that follow from the medians."""
    model, still = medians(rows[DYNAMIC]), medians(rows[CONSTANT])
    return [
        f"The dynamic model predicts {axis} worse than `constant` does ({model[k].rmse:.2f} against"
        f" {still[k].rmse:.2f} deg): this vehicle file does not describe these trials."
        for k, axis in enumerate(AXES)
        if model[k].rmse > still[k].rmse
    ]


def navigated(vehicle: str, trials: list[Trial], log: Log = lambda line: None) -> list[Navigated]:
    """The navigation filter on those trials that have an inertial unit; none without the filter."""
    having = [trial for trial in trials if trial.inertial is not None]
    if having and not is_installed():
        log("note: navigation is left out: the package uvms_observer is not installed")
        return []
    if len(having) < len(trials):
        log(
            f"note: navigation is left out in {len(trials) - len(having)} of {len(trials)} trials:"
            f" they lack one of the columns {', '.join(INERTIAL)}, or a value in it"
        )
    return [navigate(trial, navigated_vehicle(vehicle, trial)) for trial in having]


def validate(
    trials: str,
    vehicle: str,
    output: str | None,
    figures: bool,
    log: Log = lambda line: None,
    trim: bool = True,
) -> str:
    """Predict, write what was asked for, and return the table."""
    described, recorded = load_vehicle(vehicle), read_trials(trials, log)
    log(f"{len(recorded)} trials of {described.name} (some 20 s more where kernels compile first)")
    found = list(outcomes(described, recorded, trim))
    rows = table(found)
    text = table_text([each.trial.name for each in found], rows)
    text = "\n".join([text, *remarks(rows)])
    if fixed := navigated(vehicle, recorded, log):
        having = [trial for trial in recorded if trial.inertial is not None]
        text = "\n\n".join([text, navigation_text(fixed), unit_text(having, described)])
    if output is None:
        return text
    folder = Path(output)
    folder.mkdir(parents=True, exist_ok=True)
    for each in found:
        write_csv(each.trial, each.predicted[DYNAMIC].tilt, folder)
    (folder / "table.txt").write_text(text + "\n", encoding="utf-8")
    if figures:
        from uvms_analysis.trials.figures import draw  # matplotlib takes its time

        draw(found, folder)
    return text
