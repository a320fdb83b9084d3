"""Friction: histories of actuation with what rubs on the way."""
