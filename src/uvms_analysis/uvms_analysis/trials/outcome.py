"""A trial with the predictions of all models, and their scores."""

from dataclasses import dataclass

from uvms_analysis.trials.predict import Prediction
from uvms_analysis.trials.read import Trial
from uvms_analysis.trials.score import scores
from uvms_analysis.trials.sensor import sensor_tilts
from uvms_analysis.trials.table import SENSOR, Scores

DYNAMIC, QUASI_STATIC, CONSTANT = "dynamic model", "quasi-static", "constant"


@dataclass(frozen=True)
class Outcome:
    """A trial and the prediction of each model, by its name."""

    trial: Trial
    predicted: dict[str, Prediction]


def table(found: list[Outcome]) -> Scores:
    """Scores by model, over the trials."""
    models = found[0].predicted
    rows = {m: [scores(each.trial, each.predicted[m].tilt) for each in found] for m in models}
    if (tilts := sensor_tilts([each.trial for each in found])) is not None:
        pairs = zip(found, tilts, strict=True)
        rows[SENSOR] = [scores(each.trial, tilt) for each, tilt in pairs]
    return rows
