"""Values, events and questions of a simulation, and events of its viewers."""
