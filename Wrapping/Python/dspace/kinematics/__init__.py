"""Kinematics of vehicles on terrain, in numpy: see dspace.rover for what is meant to be used."""
