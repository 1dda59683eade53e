"""The exact configuration space of planar arms with two revolute joints."""
