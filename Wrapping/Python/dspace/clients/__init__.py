"""A session in this process, and the client that passes its commands on."""
