"""Whether a battery has enough left, for /diagnostics and for whoever shows it."""

from uvms_core.diagnostics import ERROR, OK, WARN

LOW = 0.2
"""Share of its charge below which a battery is low."""


def battery_status(share: float | None) -> tuple[int, str]:
    """Level and message of the share of the charge that is left, 0 to 1; None: no battery.

    WARN below `LOW`, ERROR where nothing is left.
    """
    if share is None or share >= LOW:
        return OK, "ok"
    if share > 0.0:
        return WARN, f"battery: {100.0 * share:.3g}% left"
    return ERROR, "battery: empty; thrusters and joint drives have no power"
