"""The two kinds of configuration spaces name what the other one has."""

import pytest

import cspace as cs

SCENE = cs.Scene([cs.Box([0.3, 0.3, 0.3], [1.2, 0.7, 0], name="box")])


def public_names(space) -> set[str]:
    return {name for name in dir(space) if not name.startswith("_")}


def test_attributes_of_the_other_kind_are_explained():
    exact = cs.configuration_space(cs.load_robot("planar_2r"), SCENE)
    sampled = cs.configuration_space(cs.load_robot("ur5e"), SCENE)
    for one, other in ((exact, sampled), (sampled, exact)):
        for name in public_names(other) - public_names(one) - {"arm"}:
            with pytest.raises(AttributeError, match=rf"no attribute '{name}'; .*(cs\.|slice)"):
                getattr(one, name)
        with pytest.raises(AttributeError, match=r"no attribute 'colour'$"):
            _ = one.colour


def test_the_remedies_are_there():
    arm = cs.load_robot("planar_2r")
    assert cs.configuration_space(arm, SCENE, exact=False).slice((0, 1), size=16).bitmap.shape == (16, 16)
    assert cs.configuration_space(arm, SCENE).components[0].area > 0
