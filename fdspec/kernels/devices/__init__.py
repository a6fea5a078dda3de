"""Frames whose members are made of straight lines: one general engine for every such device."""
