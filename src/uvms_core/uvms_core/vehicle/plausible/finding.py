"""One thing that is impossible or odd about a vehicle."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """What a check found: the field, its value against the bound, and the physics behind it.

    An error is impossible, for any vehicle; a warning is odd, and some vehicle may be so on
    purpose.
    """

    field: str
    text: str
    is_error: bool = False

    def __str__(self) -> str:
        return f"{self.field}: {self.text}"


def graded(
    field: str, value: float, odd: float, impossible: float, text: str, why: str
) -> list[Finding]:
    """A finding where the value is above one of two bounds.

    `text` is completed by the bound that it breaks, at `{bound}`, and the reason `why` follows.
    """
    if not value > odd:
        return []
    is_error = value > impossible
    bound = impossible if is_error else odd
    return [Finding(field, f"{text.format(bound=f'{bound:.4g}')}; {why}", is_error)]
