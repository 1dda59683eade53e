"""Expressions of xacro with a bound on the size of their values: 9**9**9 ends at once, with the reason."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from types import CodeType
from typing import Any

from cspace.tolerances import XACRO_BITS, XACRO_ITEMS

MOST_DIGITS = 18
"""Digits of a width that are read: more are too many in any case."""


def raise_power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int) and isinstance(exponent, int) and exponent > 0:
        check_bits(abs(base).bit_length() * exponent if abs(base) > 1 else 1)
    return base**exponent


def shift_bits(value: Any, bits: Any) -> Any:
    if isinstance(value, int) and isinstance(bits, int):
        check_bits(value.bit_length() + bits)
    return value << bits


def check_bits(bits: int) -> None:
    if bits > XACRO_BITS:
        raise OverflowError(f"the value has more than {XACRO_BITS} bits, which is the maximum")


def factorial_bits(n: Any) -> int:
    """A bound of the bits of n!, n^n at most."""
    return int(n).bit_length() * int(n)


def choice_bits(n: Any, k: Any = None) -> int:
    """A bound of the bits of the ways to choose or to order k of n, n^k at most."""
    return int(n).bit_length() * int(n if k is None else k)


WIDE_CALLS: dict[Callable[..., Any], Callable[..., int]] = {
    math.factorial: factorial_bits,
    math.comb: choice_bits,
    math.perm: choice_bits,
}
"""Functions whose values are longer than their arguments, and a bound of their bits."""
WIDE_POWERS: tuple[Any, ...] = (pow,)
"""Functions that are the operator **."""
WIDE_FORMATS: tuple[Any, ...] = (format, bytes, bytearray)
"""Functions that make texts as long as a number in their arguments says."""


def widths_in(text: str | bytes) -> int:
    """The sum of the numbers in a format, each of which may be a width."""
    return sum(int(number[:MOST_DIGITS]) for number in re.findall(r"\d+", str(text)))


class Budget:
    """Counts the items that one expression makes or walks over."""

    def __init__(self) -> None:
        self.items = 0

    def functions(self) -> dict[str, Callable[..., Any]]:
        """What stands in an expression for operators, calls and loops, by name."""
        return {
            "bounded_power": raise_power,
            "bounded_shift": shift_bits,
            "bounded_product": self.multiply_values,
            "bounded_sum": self.add_values,
            "bounded_format": self.format_values,
            "bounded_call": self.call,
            "bounded_items": self.count_items,
        }

    def spend(self, items: int) -> None:
        self.items += max(items, 0)
        if self.items > XACRO_ITEMS:
            raise OverflowError(f"the expression has more than {XACRO_ITEMS} items, which is the maximum")

    def multiply_values(self, a: Any, b: Any) -> Any:
        if isinstance(a, int) and isinstance(b, int):
            check_bits(a.bit_length() + b.bit_length())
        for items, count in ((a, b), (b, a)):
            if isinstance(count, int) and hasattr(items, "__len__"):
                self.spend(len(items) * count)
        return a * b

    def add_values(self, a: Any, b: Any) -> Any:
        for items in (a, b):
            if hasattr(items, "__len__"):
                self.spend(len(items))
        return a + b

    def format_values(self, a: Any, b: Any) -> Any:
        """a % b: a remainder, or a text with widths, those of its stars among the values."""
        if isinstance(a, (str, bytes)):
            self.spend(widths_in(a) + sum(x for x in (b if isinstance(b, tuple) else (b,)) if type(x) is int))
        return a % b

    def check_width(self, function: Callable[..., Any], values: Sequence[Any]) -> None:
        """Refuse a call whose value would be too long, whatever it is called with."""
        owner = getattr(function, "__self__", None)
        numbers = [value for value in values if isinstance(value, int)]
        if isinstance(owner, (str, bytes)):
            is_format = getattr(function, "__name__", "") in ("format", "format_map")
            self.spend(sum(map(abs, numbers)) + (widths_in(owner) if is_format else 0))
        elif function in WIDE_FORMATS:
            texts = [value for value in values if isinstance(value, str)]
            self.spend(sum(map(widths_in, texts)) + (0 if function is format else sum(map(abs, numbers))))
        elif function in WIDE_POWERS and len(values) == 2:
            raise_power(*values)
        elif function in WIDE_CALLS and len(numbers) == len(values) and all(n >= 0 for n in numbers):
            check_bits(WIDE_CALLS[function](*numbers))

    def multiply_items(self, items: Iterable[Any], *, start: Any = 1) -> Any:
        """math.prod, its product bounded at each step."""
        for item in self.count_items(items):
            start = self.multiply_values(start, item)
        return start

    def call(self, function: Callable[..., Any], *values: Any, **named: Any) -> Any:
        """A call: a range among its values counts with its length, the width of a text with its value."""
        function = self.multiply_items if function is math.prod else function
        if isinstance(function, Hashable):
            self.check_width(function, values)
        for value in (*values, *named.values()):
            if isinstance(value, range):
                self.spend(max(0, -((value.start - value.stop) // value.step)))
        return function(*values, **named)

    def count_items(self, items: Iterable[Any]) -> Iterator[Any]:
        """The items of a loop, each of which counts."""
        for item in items:
            self.spend(1)
            yield item


BOUNDED: dict[type[ast.operator], str] = {
    ast.Pow: "bounded_power",
    ast.LShift: "bounded_shift",
    ast.Mult: "bounded_product",
    ast.Add: "bounded_sum",
    ast.Mod: "bounded_format",
}
"""The operators whose values may be long."""


class BoundOperators(ast.NodeTransformer):
    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        if type(node.op) not in BOUNDED:
            return node
        return replace_node(node, BOUNDED[type(node.op)], [node.left, node.right])

    def visit_Call(self, node: ast.Call) -> ast.AST:
        self.generic_visit(node)
        return replace_node(node, "bounded_call", [node.func, *node.args], node.keywords)

    def visit_comprehension(self, node: ast.comprehension) -> ast.AST:
        self.generic_visit(node)
        node.iter = replace_node(node.iter, "bounded_items", [node.iter])
        return node


def replace_node(
    node: ast.expr, function: str, values: list[ast.expr], named: Sequence[ast.keyword] = ()
) -> ast.Call:
    """The call of a function in place of a node."""
    return ast.copy_location(ast.Call(ast.Name(function, ast.Load()), values, list(named)), node)


def compile_bounded(text: str) -> CodeType:
    """The code of an expression whose operators, calls and loops are bounded, by functions of a Budget."""
    tree = BoundOperators().visit(ast.parse(text.strip(), "<expression>", "eval"))
    return compile(ast.fix_missing_locations(tree), "<expression>", "eval")


def evaluate_bounded(text: str, names: dict[str, Any], local: Any = None) -> Any:
    """The value of an expression in which only these names are known; dunder names are refused."""
    code = compile_bounded(text)
    if bad := [name for name in code.co_names if name.startswith("__")]:
        raise ValueError(f"names that begin with two underscores are not allowed: {', '.join(bad)}")
    names.update(__builtins__=Budget().functions())
    return eval(code, names, local)
