"""The identity of a run: a short text that its nodes, its log and its summary carry."""

import secrets


def new_run_id() -> str:
    """Twelve hexadecimal digits: among a million runs, two share one with a chance of 0.2 %."""
    return secrets.token_hex(6)
