"""One benchmark a file; the first line of its docstring says what it measures."""
