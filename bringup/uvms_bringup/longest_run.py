"""How long anything of a run may take."""

LONGEST_RUN_S = 1e6
"""No run, and so no goal, is longer."""
