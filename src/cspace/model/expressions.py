"""Expressions of xacro with a bound on the size of their values: 9**9**9 ends at once, with the reason."""

from __future__ import annotations

import ast
from collections.abc import Callable
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


def multiply_values(a: Any, b: Any) -> Any:
    if isinstance(a, int) and isinstance(b, int):
        check_bits(a.bit_length() + b.bit_length())
    for items, count in ((a, b), (b, a)):
        if isinstance(count, int) and hasattr(items, "__len__") and len(items) * count > XACRO_ITEMS:
            raise OverflowError(f"the value has more than {XACRO_ITEMS} items, which is the maximum")
    return a * b


def check_bits(bits: int) -> None:
    if bits > XACRO_BITS:
        raise OverflowError(f"the value has more than {XACRO_BITS} bits, which is the maximum")


BOUNDED: dict[type[ast.operator], tuple[str, Callable[[Any, Any], Any]]] = {
    ast.Pow: ("bounded_power", raise_power),
    ast.LShift: ("bounded_shift", shift_bits),
    ast.Mult: ("bounded_product", multiply_values),
}
"""The operators whose values may be long, and the functions that stand for them."""


class BoundOperators(ast.NodeTransformer):
    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        if type(node.op) not in BOUNDED:
            return node
        function = ast.Name(BOUNDED[type(node.op)][0], ast.Load())
        return ast.copy_location(ast.Call(function, [node.left, node.right], []), node)


def compile_bounded(text: str) -> CodeType:
    """The code of an expression whose operators are bounded."""
    tree = BoundOperators().visit(ast.parse(text.strip(), "<expression>", "eval"))
    return compile(ast.fix_missing_locations(tree), "<expression>", "eval")


def evaluate_bounded(text: str, names: dict[str, Any], local: Any = None) -> Any:
    """The value of an expression in which only these names are known; dunder names are refused."""
    code = compile_bounded(text)
    if bad := [name for name in code.co_names if name.startswith("__")]:
        raise ValueError(f"names that begin with two underscores are not allowed: {', '.join(bad)}")
    names.update(__builtins__=dict(BOUNDED.values()))
    return eval(code, names, local)
