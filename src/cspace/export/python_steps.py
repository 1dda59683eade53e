"""The steps of a closed form as Python functions: the equations of the arm with its numbers."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import numpy as np

from cspace.export.arm import ExportedArm
from cspace.export.texts import in_ascii
from cspace.ik.explain.describe import settled_plan
from cspace.ik.explain.findings import Step
from cspace.ik.explain.page import plain_sentence
from cspace.ik.explain.plan import IkPlan
from cspace.math import Equation, TrigPolynomial

UNITS = {"": "", "m": " / LENGTH", "m²": " / LENGTH**2", "m⁴": " / LENGTH**4"}
"""What the sides of an equation are divided by."""
WIDTH = 100


def python_steps(arm: ExportedArm) -> str:
    """A function per step, the list of the steps, and the angles t1 … t6 after the last one."""
    plan = settled_plan(arm.solver, IkPlan(arm.title, arm.solver.joint_names))
    steps = [step for step in plan.steps if step.angles]
    writer = Writer(sorted(word for step in steps for word in step.angles.split()), plan.constants)
    functions = "\n\n".join(writer.function(step) for step in steps)
    rows = "".join(f"    ({name_of(step)}, {names_of(step)}),\n" for step in steps)
    angles = ", ".join(writer.angle({joint: 1}) for joint in range(1, 7))
    return f'{functions}\n\nARM["steps"] = [\n{rows}]\nARM["angles"] = lambda k: ({angles})\n'


def name_of(step: Step) -> str:
    """The name of the function of a step."""
    return "equations_of_t" + step.angles.replace(" ", "_t")


def names_of(step: Step) -> tuple[str, ...]:
    """The names of the angles that a step fixes."""
    return tuple(f"t{word}" for word in step.angles.split())


class Writer:
    """words: the angles that the steps fix, each a sum of joints' angles; numbers: those of the symbols."""

    def __init__(self, words: list[str], numbers: Mapping[str, float]) -> None:
        self.words, self.numbers = words, numbers
        joints_of_words = [[float(str(joint) in word) for joint in range(1, 7)] for word in words]
        self.words_of_joints = np.linalg.inv(joints_of_words)

    def angle(self, joints: Mapping[int, int]) -> str:
        """A sum of joints' angles by the angles that the steps fix."""
        times = sum(count * self.words_of_joints[joint - 1] for joint, count in joints.items())
        return sum_of_products(
            [(float(n), [f"k.t{word}"]) for n, word in zip(times, self.words, strict=True)]
        )

    def function(self, step: Step) -> str:
        """The equations of a step, left - right; its definitions become known."""
        turns: dict[str, str] = {}
        known, zero = [], []
        for equation in step.equations:
            assert isinstance(equation, Equation)
            special = equation.with_numbers(self.numbers)
            if equation.defines:
                known.append(f"    k.{equation.defines} = {self.write(special.right, turns, 4)}")
            else:
                difference = self.write(special.left - special.right, turns, 8)
                unit = UNITS[equation.unit]
                if unit and not difference.startswith("("):
                    difference = f"({difference})"
                zero.append(f"        {difference}{unit},")
        how = f" (up to {step.ways} ways)" if step.ways > 1 else ""
        words = in_ascii(plain_sentence(f"{step.finds}{how}. {step.words}"))
        title = textwrap.fill(f'"""{words}"""', WIDTH, initial_indent="    ", subsequent_indent="    ")
        before = [f"    {name} = {value}" for name, value in sorted(turns.items())]
        head = f"def {name_of(step)}(k: Known) -> list[float]:\n{title}"
        return "\n".join([head, *before, *known, "    return [", *zero, "    ]\n"])

    def write(self, polynomial: TrigPolynomial, turns: dict[str, str], indent: int) -> str:
        """A polynomial; turns: the cosines and sines in it by name, to which it adds."""
        products = []
        for (plain, factors), number in polynomial.terms.items():
            words = [f"k.{name}" if power == 1 else f"k.{name}**{power}" for name, power in plain]
            for _, kind, angle in factors:
                name = kind + "".join(f"{i}" for i, times in angle)
                sum_of_words = self.angle(dict(angle))
                if sum_of_words == f"k.t{name[1:]}":
                    name = f"k.{name}"
                else:
                    turns[name] = f"{'cos' if kind == 'c' else 'sin'}({sum_of_words})"
                words.insert(0, name)
            products.append((number, words))
        text = sum_of_products(products)
        if len(text) + indent < WIDTH:
            return text
        around = " " * indent
        inside = textwrap.fill(text, WIDTH, initial_indent=f"{around}    ", subsequent_indent=f"{around}    ")
        return f"(\n{inside}\n{around})"


def sum_of_products(products: list[tuple[float, list[str]]]) -> str:
    """Numbers times words: 0.5 * c1 * k.p_x - s2."""
    text = ""
    for number, words in products:
        if number:
            size = [repr(float(abs(number)))] if abs(number) != 1 or not words else []
            sign = "-" if number < 0 else "+" if text else ""
            text += (f" {sign} " if text else sign) + " * ".join([*size, *words])
    return text or "0.0"
