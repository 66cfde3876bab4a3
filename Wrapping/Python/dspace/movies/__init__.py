"""Movies of a run along camera key frames."""
