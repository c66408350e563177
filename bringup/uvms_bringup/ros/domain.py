"""The ROS domain of a run: a free one is found, an occupied one is refused.

Runs of this machine tell one another by a lock on a file for each domain. Whoever else is in the
domain is seen by the port that every participant of DDS opens there, and in the graph
(`uvms_bringup.ros.graph_watch`).
"""

import os
import socket
import tempfile
from collections.abc import Mapping, MutableMapping
from pathlib import Path

from uvms_bringup.claim import Claim, Holder, TakenError
from uvms_bringup.errors import RunError

DOMAINS = range(1, 101)
"""Those that are chosen from: above, DDS takes ports that the system gives to others."""
_FIRST_PORT, _PORTS_A_DOMAIN, _OF_FIRST_PARTICIPANT = 7400, 250, 10
"""DDSI-RTPS 2.2, 9.6.1: the first participant on a machine listens at their sum for a domain."""


def claim_domain(values: MutableMapping[str, str], holder: Holder) -> Claim | None:
    """Claim the domain that the environment names, or a free one, which is then put there.

    Returns None where another user's file stands in the way; the graph is looked at all the same.

    Raises:
        RunError: the domain is taken by another run, or all are.
    """
    if given := values.get("ROS_DOMAIN_ID"):
        return _claim_given(given, holder)
    for offset in range(len(DOMAINS)):
        domain = DOMAINS[(os.getpid() + offset) % len(DOMAINS)]
        if is_silent(domain):
            try:
                claim = Claim(_file(domain), holder)
            except (TakenError, OSError):
                continue
            values["ROS_DOMAIN_ID"] = str(domain)
            return claim
    raise RunError(
        f"all ROS domains from {DOMAINS[0]} to {DOMAINS[-1]} are in use on this machine; end a run,"
        " or set ROS_DOMAIN_ID to one that you know to be free"
    )


def _claim_given(given: str, holder: Holder) -> Claim | None:
    try:
        return Claim(_file(int(given)), holder)
    except TakenError as other:
        raise RunError(
            f"ROS_DOMAIN_ID={given} is in use by {other}; wait for its end, set another"
            " ROS_DOMAIN_ID, or set none, so that a free one is chosen"
        ) from other
    except ValueError as fault:
        raise RunError(f"ROS_DOMAIN_ID={given!r}: must be a whole number") from fault
    except OSError:
        return None


def _file(domain: int) -> Path:
    return Path(tempfile.gettempdir()) / f"uvms_domain_{domain}.lock"


def may_have_others(values: Mapping[str, str]) -> bool:
    """Whether somebody may be in the domain that the environment names, here or elsewhere."""
    beyond = values.get("ROS_AUTOMATIC_DISCOVERY_RANGE") not in ("LOCALHOST", "OFF")
    return beyond or not is_silent(int(values["ROS_DOMAIN_ID"]))


def is_silent(domain: int) -> bool:
    """Whether no participant of DDS on this machine is in the domain."""
    port = _FIRST_PORT + _PORTS_A_DOMAIN * domain + _OF_FIRST_PARTICIPANT
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("", port))
        except OSError:
            return False
    return True
