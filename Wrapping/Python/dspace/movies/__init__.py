"""Movies of a run with cameras that follow key frames."""
