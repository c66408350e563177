"""Recorded trials of a real vehicle: reading, predicting, scoring, identifying from them."""
