"""An MJCF document in one piece: the main file with every <include> put in its place."""

from __future__ import annotations

import os

from cspace.errors import DescriptionError
from cspace.model.attributes import fault_at, text_of
from cspace.model.files import read_bytes
from cspace.model.xml import Element, parse_document
from cspace.tolerances import DESCRIPTION_BYTES, DESCRIPTION_DEPTH


class Includes:
    """Puts the included files in their places; each element knows its file and line.

    An included file is looked for beside the main file, then beside the file that includes it; its root's
    children take the place of <include>. As in MuJoCo a file is included once, so there are no circles.
    Raises DescriptionError for files that are missing, broken or included twice, and for elements nested
    deeper than tolerances.DESCRIPTION_DEPTH.
    """

    def __init__(self, root: Element) -> None:
        self.main = root.path
        self.seen = set() if root.path is None else {os.path.realpath(root.path)}
        self.bytes = 0
        self.root = root

    def resolve(self) -> None:
        stack = [(self.root, 1)]
        while stack:
            element, depth = stack.pop()
            if depth > DESCRIPTION_DEPTH:
                text = f"elements are nested more than {DESCRIPTION_DEPTH} deep; this is no robot"
                raise fault_at(element, text)
            while any(child.tag == "include" for child in element.children):
                element.children = [part for child in element.children for part in self.parts(child)]
            stack.extend((child, depth + 1) for child in element.children)

    def parts(self, element: Element) -> list[Element]:
        """What stands for an element: itself, or what the file holds that it includes."""
        if element.tag != "include":
            return [element]
        if element.children:
            raise fault_at(element, "<include> holds elements; what is included stands in its file")
        included = self.included(element)
        if not included.children:
            raise fault_at(element, f"the included file {included.path!r} holds no elements")
        return included.children

    def included(self, element: Element) -> Element:
        name = text_of(element, "file")
        if self.main is None or element.path is None:
            raise fault_at(
                element, f"{name!r} is included by a text, which has no folder; give the file's path"
            )
        places = [os.path.join(os.path.dirname(path), name) for path in (self.main, element.path)]
        path = next((place for place in places if os.path.isfile(place)), places[0])
        if os.path.realpath(path) in self.seen:
            raise fault_at(element, f"the file {name!r} is included a second time; MuJoCo takes a file once")
        self.seen.add(os.path.realpath(path))
        try:
            data = read_bytes(path)
        except DescriptionError as error:
            raise fault_at(element, f"<include file={name!r}>: {error}") from None
        self.bytes += len(data)
        if self.bytes > DESCRIPTION_BYTES:
            raise fault_at(element, f"the included files hold more than {DESCRIPTION_BYTES} bytes")
        return parse_document(data, path)
