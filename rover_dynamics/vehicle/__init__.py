"""Vehicles on wheels: a tree of bodies, tires on terrain, implicit integration; the rover is one."""
