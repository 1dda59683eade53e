"""Mechanisms: robots whose links close loops, with four well-known ones ready-made."""

from cspace.mechanisms.delta import Delta
from cspace.mechanisms.four_bar import FourBar
from cspace.mechanisms.mechanism import Mechanism
from cspace.mechanisms.slider_crank import SliderCrank
from cspace.mechanisms.stewart import Stewart

__all__ = ["Delta", "FourBar", "Mechanism", "SliderCrank", "Stewart"]
