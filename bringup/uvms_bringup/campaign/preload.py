"""Imported once by the server that worker processes are forked from.

A run of a moment loads every kernel, and compiles those that are not compiled yet, once instead of
in each worker.
"""

from contextlib import suppress

from uvms_bringup.campaign.single import summary_of
from uvms_bringup.scenario import load_scenario
from uvms_core.errors import UvmsError

MOMENT_S = 1.0
"""Two steps of the planner."""

with suppress(UvmsError):  # the runs themselves will say what is wrong
    summary_of(load_scenario("hover", duration_s=MOMENT_S))
