"""Errors of the machine: a full disk or a folder that is gone says nothing about a run."""

OF_THE_MACHINE = (OSError, MemoryError)


def is_of_the_machine(fault: BaseException | None) -> bool:
    """Whether an error, or one that it was raised from, came from the system."""
    while fault is not None:
        if isinstance(fault, OF_THE_MACHINE):
            return True
        fault = fault.__cause__
    return False
