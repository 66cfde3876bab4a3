"""Lines of sight and horizons."""
