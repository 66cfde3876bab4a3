"""The data that come with Dspace: where they are, and the field as a scene."""
