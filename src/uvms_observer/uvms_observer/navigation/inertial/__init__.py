"""The inertial unit, which carries the state: where it sits, which readings are believed, gaps."""
