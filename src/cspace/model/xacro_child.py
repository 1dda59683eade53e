"""The process that expands a xacro file: runs the package xacro and records the origin of each element."""

from __future__ import annotations

import builtins
import json
import os
import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any
from xml.dom import expatbuilder, minidom

from cspace.errors import CspaceError, DescriptionError, suggest
from cspace.model.expressions import Budget, compile_bounded, evaluate_bounded
from cspace.model.files import locate_package, read_bytes
from cspace.model.xml import parse_document
from cspace.tolerances import XACRO_COPIES, XACRO_ELEMENTS, XACRO_ITEMS

Place = tuple[str, int]
"""A file and a line."""

WATCHED = ("grab_property", "grab_macro", "process_include", "handle_macro_call", "check_attrs", "eval_all")
"""The functions of xacro whose first argument is the element at work."""


def main(request: dict[str, Any]) -> None:
    """Write the result of one request to the standard output: the elements, or the error in the file."""
    answers, sys.stdout = sys.stdout, sys.stderr  # xacro prints
    json.dump(answer_request(request), answers)


def answer_request(request: dict[str, Any]) -> dict[str, Any]:
    """The expanded document as JSON data, or the fault that ends it."""
    arguments = Arguments(request["arguments"])
    expansion = Expansion(request["file"], request["package_paths"])
    try:
        root = expansion.run(arguments)
    except DescriptionError as error:  # of a file: malformed, entities
        if error.path is not None and error.line is not None:
            fault = str(error).removeprefix(f"{error.path}:{error.line}: ")
            return {"fault": fault, "file": error.path, "line": error.line}
        fault = str(error)
    except RecursionError:
        fault = "its macros or includes call each other without end"
    except Exception as error:
        fault = fault_text(error)
    else:
        for name in request["arguments"]:
            if name not in arguments.asked:
                return {"unknown": str(suggest("argument", name, arguments.asked, owner="the xacro file"))}
        files: dict[str, int] = {}
        rows = [
            (depth, tag, attributes, files.setdefault(file, len(files)), line)
            for depth, tag, attributes, (file, line) in list_elements(root, (request["file"], 1))
        ]
        return {"files": list(files), "elements": rows}
    return {"fault": fault, "file": expansion.place[0], "line": expansion.place[1]}


def fault_text(error: Exception) -> str:
    """What xacro complains about, in one line."""
    cause = getattr(error, "exc", None)
    if isinstance(cause, CspaceError):
        return str(cause)
    text = " ".join(str(error).split()) or type(error).__name__
    return text if type(error).__name__ == "XacroException" else f"{type(error).__name__}: {text}"


class Arguments(dict[str, str]):
    """The given arguments, which record the names that the file requests."""

    def __init__(self, given: dict[str, str]) -> None:
        super().__init__(given)
        self.asked: set[str] = set()

    def __contains__(self, name: object) -> bool:
        self.asked.add(str(name))
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        self.asked.add(name)
        return super().__getitem__(name)


class Expansion:
    """One run of xacro, with the place where it is."""

    def __init__(self, file: str, package_paths: list[str]) -> None:
        self.file = file
        self.package_paths = package_paths
        self.place: Place = (file, 1)
        self.steps = self.copies = 0

    def run(self, arguments: Arguments) -> minidom.Element:
        """The root element of the document that the file makes."""
        xacro: Any = import_module("xacro")
        substitution_args: Any = import_module("xacro.substitution_args")
        substitution_args._eval_find = self.find
        substitution_args._eval_dict["find"] = self.find
        self.parse_original = xacro.parse
        self.xacro = xacro
        xacro.safe_eval = evaluate_bounded
        substitution_args.eval = evaluate_argument
        xacro.parse = self.parse
        for name in WATCHED:
            if hasattr(xacro, name):
                setattr(xacro, name, self.watched(getattr(xacro, name)))
        xacro.eval_text = self.measured(xacro.eval_text)
        elements: Any = minidom.Element
        copy = elements.cloneNode
        elements.cloneNode = lambda node, deep: self.count_copies(with_places(node, copy(node, deep)))
        root: minidom.Element = xacro.process_file(self.file, mappings=arguments, verbosity=0).documentElement
        return root

    def count_copies(self, element: minidom.Element) -> minidom.Element:
        """A copied element, which counts with all inside it: what blocks insert into blocks grows so."""
        self.copies += 1 + len(element.getElementsByTagName("*"))
        if self.copies > XACRO_COPIES:
            raise DescriptionError(
                f"the expansion copies more than {XACRO_COPIES} elements, which is the maximum"
            )
        return element

    def measured(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The same function, whose texts are no longer than what one expression may make."""

        def wrapper(*given: Any, **options: Any) -> Any:
            value = function(*given, **options)
            if isinstance(value, str) and len(value) > XACRO_ITEMS:
                raise DescriptionError(f"a text has more than {XACRO_ITEMS} characters, which is the maximum")
            return value

        return wrapper

    def find(self, name: str) -> str:
        """The folder of a package: the value of $(find name)."""
        return locate_package(name, os.path.dirname(os.path.abspath(self.file)), self.package_paths)

    def parse(self, source: Any, filename: str | None = None) -> Any:
        """xacro.parse, with the checks and the places of our own reader."""
        if source is not None or filename is None:
            return self.parse_original(source, filename)
        try:
            data = read_bytes(filename)
        except DescriptionError as error:
            self.xacro.filestack.pop()
            raise self.xacro.XacroException(str(error), exc=OSError()) from None
        parse_document(data, filename)
        return Placed(filename).parseString(data)

    def watched(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The same function, after noting which element it works on."""

        def wrapper(element: Any, *rest: Any, **options: Any) -> Any:
            before, self.place = self.place, getattr(element, "place", self.place)
            self.steps += 1
            if self.steps > XACRO_ELEMENTS:
                raise DescriptionError(
                    f"the expansion has more than {XACRO_ELEMENTS} elements, which is the maximum"
                )
            result = function(element, *rest, **options)
            if function.__name__ != "check_attrs":  # what it has checked is at work now
                self.place = before
            return result

        wrapper.__name__ = function.__name__
        return wrapper


def evaluate_argument(text: str, _: Any, names: Any) -> Any:
    """The value of $(eval …): names is a mapping that finds the arguments of the file."""
    return eval(compile_bounded(text), {"__builtins__": vars(builtins) | Budget().functions()}, names)


class Placed(expatbuilder.ExpatBuilderNS):
    """Builds a document whose elements know their file and line."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self.file = file

    def start_element_handler(self, name: str, attributes: Any) -> None:
        super().start_element_handler(name, attributes)
        element: Any = self.curNode
        element.place = (self.file, self.getParser().CurrentLineNumber)


def with_places(node: Any, copy: Any) -> Any:
    """A copied element whose parts have the places of the first one's."""
    stack = [(node, copy)]
    while stack:
        old, new = stack.pop()
        if hasattr(old, "place"):
            new.place = old.place
        stack.extend(zip(old.childNodes, new.childNodes, strict=False))
    return copy


def list_elements(root: minidom.Element, place: Place) -> Iterator[tuple[int, str, dict[str, str], Place]]:
    """An element and all inside it: depth, tag, attributes, place."""
    stack = [(0, root, place)]
    while stack:
        depth, element, place = stack.pop()
        place = getattr(element, "place", place)
        yield depth, element.tagName, dict(element.attributes.items()), place
        inside = [node for node in element.childNodes if node.nodeType == node.ELEMENT_NODE]
        stack.extend((depth + 1, node, place) for node in reversed(inside))
