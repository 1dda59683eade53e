"""The functions of the core that choose a closed form, written anew for the one that an arm has."""

from __future__ import annotations

from typing import Any

__all__ = ["general_method", "only_this_family", "other_families"]

FIRST_THREE = ("last_parallel", "first_meet", "last_meet", "first_parallel", "general")
SPHERICAL_WRIST, THREE_PARALLEL, MIDDLE_PARALLEL = 1, 2, 3

ARGUMENTS = "const ik::Plan& plan, const {}& goal, const Care& care"
FORM = f"template <class V>\nCSPACE_INLINE Branches<V> closed_form({ARGUMENTS.format('Pose<V>')})"
ABREAST = f"CSPACE_INLINE Abreast closed_form_abreast({ARGUMENTS.format('Posed')})"
PLACE = (
    "template <ik::FirstThree, class V>\n"
    "CSPACE_INLINE Triples<V> place_wrist(const ik::ThreeJoints& g, const Vec3<V>& p, const Care& care)"
)


def only_this_family(plan: dict[str, Any]) -> dict[str, str]:
    """The definitions by the names of those that they replace."""
    if plan["family"] == SPHERICAL_WRIST:
        case = FIRST_THREE[plan["wrist"]["first"]["kind"]]
        call = f"<ik::FirstThree::{case}>(plan.wrist, goal, care)"
        place = "any_three" if case == "general" else case
        return {
            "closed_form": returning(FORM, "solve" + call),
            "closed_form_abreast": returning(ABREAST, "solve_abreast" + call),
            "place_wrist": returning(PLACE, f"{place}(g, p, care)"),
        }
    if plan["family"] == THREE_PARALLEL:
        call = "(plan.parallel, goal, care)"
        return {
            "closed_form": returning(FORM, "solve" + call),
            "closed_form_abreast": returning(ABREAST, "solve_abreast" + call),
        }
    middle = plan["family"] == MIDDLE_PARALLEL
    name = "solve_middle_parallel" if middle else "solve_first_parallel"
    return {"closed_form": returning(FORM, f"{name}(plan.form, goal, care)")}


def general_method(arm: dict[str, Any]) -> dict[str, str]:
    """The function of the general solver that chooses a method, written anew for that of an arm."""
    if arm["position_first"]:
        calls = ["solve_with_wrist(arm, goal, out);"]
    elif arm["has_neighbours"]:
        calls = ["solve_beside(arm, goal, out);", "if (!out.complete) solve_by_plan(arm.plan, goal, out);"]
    else:
        calls = ["solve_by_plan(arm.plan, goal, out);"]
    signature = "inline void solve_general(const ik::GeneralArm& arm, const Posed& goal, ik::Solutions& out)"
    return {"solve_general": f"{signature} {{\n" + "".join(f"    {call}\n" for call in calls) + "}"}


def other_families(kind: str, plan: dict[str, Any]) -> set[str]:
    """Names by which solvers that this arm does not need, called alike, are told from its own."""
    if kind in ("any", "locked"):
        return set()
    if kind == "closed":
        unwanted = {SPHERICAL_WRIST: {"finish_in_plane"}, THREE_PARALLEL: {"place_wrist"}}
        return unwanted.get(plan["family"], {"place_wrist", "finish_in_plane"})
    unwanted_here = {"place_wrist", "finish_in_plane", "closed_form", "closed_form_abreast"}
    return unwanted_here | ({"solve_position"} if plan.get("position_first") == {} else set())


def returning(signature: str, value: str) -> str:
    return f"{signature} {{\n    return {value};\n}}"
