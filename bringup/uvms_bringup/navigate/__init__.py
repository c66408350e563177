"""`uvms navigate`: the navigation filter over a recorded log, of this system or of any other."""
