"""A sensor brought from outside: acoustic positioning, as a ship's USBL gives it."""
