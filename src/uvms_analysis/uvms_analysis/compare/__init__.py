"""`uvms compare`: runs side by side, as a table of their summaries and as a page."""

from uvms_analysis.compare.compare import Compared, compare

__all__ = ["Compared", "compare"]
