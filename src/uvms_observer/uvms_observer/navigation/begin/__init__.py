"""How the filter begins, and begins again: attitude, place, what is still missing."""
