import pytest

import cspace


def test_the_compiled_core_and_the_package_have_one_version():
    assert cspace.__version__ == cspace._core.__version__


def test_completion_offers_the_public_names_and_nothing_else():
    offered = {name for name in dir(cspace) if not name.startswith("_")}
    assert offered == {*cspace.__all__, "errors", "tolerances"} - {"__version__"}
    assert all(hasattr(cspace, name) for name in offered)


def test_an_unknown_name_carries_what_python_needs_to_suggest_another():
    with pytest.raises(AttributeError) as caught:
        _ = cspace.load_robt
    assert caught.value.name == "load_robt"
    assert caught.value.obj is cspace
