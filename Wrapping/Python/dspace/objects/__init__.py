"""What frames carry: graphics objects, robots, assemblies, fragments and lights."""
