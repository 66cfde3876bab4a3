"""Connections to a server: drivers, viewers, and the server's own process."""
