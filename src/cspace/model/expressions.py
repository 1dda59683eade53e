"""Expressions of xacro with a bound on the size of their values: 9**9**9 ends at once, with the reason."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Sequence
from types import CodeType
from typing import Any

from cspace.tolerances import XACRO_BITS, XACRO_ITEMS


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

    def call(self, function: Callable[..., Any], *values: Any, **named: Any) -> Any:
        """A call: a range among its values counts with its length, the width of a text with its value."""
        for value in (*values, *named.values()):
            if isinstance(value, range):
                self.spend(max(0, -((value.start - value.stop) // value.step)))
            elif isinstance(value, int) and isinstance(getattr(function, "__self__", None), (str, bytes)):
                self.spend(value)
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
