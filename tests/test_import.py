import cspace


def test_the_compiled_core_and_the_package_have_one_version():
    assert cspace.__version__ == cspace._core.__version__
