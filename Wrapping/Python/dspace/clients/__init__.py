"""A session in this process, and the client that executes its commands."""
