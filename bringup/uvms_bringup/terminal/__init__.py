"""What a run shows on the terminal while it goes on: a panel, or a line every few seconds."""
