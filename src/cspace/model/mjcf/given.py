"""What an element says, by itself or through the default classes behind it."""

from __future__ import annotations

from collections.abc import Sequence

from cspace.errors import suggest
from cspace.model.attributes import fault_at, read_floats
from cspace.model.values import BEYOND
from cspace.model.xml import Element
from cspace.tolerances import LARGEST_NUMBER

MAIN = "main"

ACTUATORS = (
    *("general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion"),
    *("pid", "orientation", "dcmotor", "plugin"),
)
"""The kinds of actuators: a class holds one set of values for all of them."""


class Given:
    """An element with the elements that stand in for attributes it does not have, the nearest first."""

    __slots__ = ("behind", "element")

    def __init__(self, element: Element, behind: Sequence[Element] = ()) -> None:
        self.element = element
        self.behind = behind

    def holder(self, *names: str) -> Element | None:
        """The nearest element that has any of the attributes."""
        return next((e for e in (self.element, *self.behind) if any(n in e.attributes for n in names)), None)

    def place(self, name: str) -> Element:
        """Where a complaint about an attribute belongs: the nearest element that has it, else this one."""
        return self.holder(name) or self.element

    def text(self, name: str, default: str = "") -> str:
        """The text of an attribute."""
        holder = self.holder(name)
        return default if holder is None else holder.attributes[name].strip()

    def floats(
        self, name: str, default: Sequence[float] | None, least: int, most: int | None = None
    ) -> list[float]:
        """The numbers of an attribute, `least` to `most` (default: as many), no larger than robots go."""
        holder = self.place(name)
        numbers = read_floats(holder, name, default, least, most)
        largest = max(numbers, key=abs, default=0.0)
        if abs(largest) > LARGEST_NUMBER:
            raise fault_at(holder, f"{name} of <{holder.tag}> holds {largest:g}; {BEYOND}")
        return numbers

    def span(self, name: str) -> tuple[float, float]:
        """A range, from 0 to 0 where it is not given; its ends may stand for infinity and be of any size."""
        low, high = read_floats(self.place(name), name, (0.0, 0.0), 2)
        return low, high

    def number(self, name: str, default: float | None = None) -> float:
        """One finite number."""
        return self.floats(name, None if default is None else [default], 1)[0]

    def word(self, name: str, default: str, known: Sequence[str]) -> str:
        """One of the known words."""
        holder = self.holder(name)
        if holder is None:
            return default
        word = holder.attributes[name].strip()
        if word not in known:
            error = suggest("value", word, known, owner=f"{name} of <{holder.tag}>")
            raise fault_at(holder, str(error))
        return word

    def flag(self, name: str, default: bool) -> bool:
        """true or false."""
        return self.word(name, "true" if default else "false", ("true", "false")) == "true"


class Defaults:
    """The default classes of a document.

    A class contains the values of its <default>, then those of the class in which it is nested. The
    outermost class counts for elements that name none.
    """

    def __init__(self, root: Element) -> None:
        self.behind: dict[str, dict[str, tuple[Element, ...]]] = {MAIN: {}}
        for section in root.all("default"):
            outermost = section.attributes.get("class", MAIN)
            self.behind[outermost] = self.behind[MAIN] = self.add(section, self.behind[MAIN])
            self.read_nested(section, outermost)

    def read_nested(self, section: Element, name: str) -> None:
        """The classes inside a class: each begins with the values of the outer one so far."""
        stack = [(section, name)]
        while stack:
            section, outer = stack.pop()
            for nested in section.all("default"):
                name = nested.attributes.get("class", "")
                if not name or name in self.behind:
                    raise fault_at(
                        nested, f"a second default class {name!r}" if name else "a class needs a name"
                    )
                self.behind[name] = self.add(nested, self.behind[outer])
                stack.append((nested, name))

    def add(self, section: Element, outer: dict[str, tuple[Element, ...]]) -> dict[str, tuple[Element, ...]]:
        """What stands behind elements of each tag: the section's own, the last first, then the outer ones."""
        found = dict(outer)
        for element in section.children:
            if element.tag != "default":
                tag = class_slot(element)
                found[tag] = (element, *found.get(tag, ()))
        return found

    def given(self, element: Element, around: str | None = None) -> Given:
        """The element with its class behind it: the one it names, else that of the bodies around it."""
        name = element.attributes.get("class", around or MAIN)
        return Given(element, self.known(name, element).get(class_slot(element), ()))

    def known(self, name: str, element: Element) -> dict[str, tuple[Element, ...]]:
        """The class of that name; `element` is where a complaint belongs."""
        if name not in self.behind:
            raise fault_at(element, str(suggest("default class", name, self.behind)))
        return self.behind[name]


def class_slot(element: Element) -> str:
    """The tag under which a class stores the defaults of an element."""
    return "general" if element.tag in ACTUATORS else element.tag
