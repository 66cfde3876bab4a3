"""Data sets: many images of a run, with their calibration and labels."""
