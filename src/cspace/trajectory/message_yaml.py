"""Messages of ROS in YAML, read by PyYAML."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, Final

from cspace.errors import DescriptionError, MissingExtraError

SHORT_REAL: Final = re.compile(r"[-+]?[0-9]+(?:\.[0-9]*)?[eE][-+]?[0-9]+")
"""A number as 1e-5, which PyYAML takes for text: YAML 1.1 asks for a point and a sign."""


def read_documents(text: str, path: str) -> list[Any]:
    """The documents of a text, as dictionaries, lists, numbers, texts, booleans and None.

    Raises DescriptionError with the line where the text is no YAML, and MissingExtraError without PyYAML
    (`pip install 'cspace[ros]'`).
    """
    try:
        import yaml  # type: ignore[import-untyped]
    except ModuleNotFoundError:
        raise MissingExtraError("ros", f"reading {path!r}, a message in YAML,") from None
    try:
        return [each for each in yaml.load_all(text, _make_loader()) if each is not None]
    except yaml.MarkedYAMLError as error:
        line = None if error.problem_mark is None else error.problem_mark.line + 1
        raise DescriptionError(f"the file is no YAML: {error.problem}", path=path, line=line) from None
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError, LookupError, AttributeError) as error:
        # PyYAML raises the last two for values that do not fit their tags.
        raise DescriptionError(f"the file is no YAML: {str(error) or 'too deep'}", path=path) from None


@lru_cache(maxsize=1)
def _make_loader() -> Any:
    """The loader of PyYAML for plain values that knows short numbers, compiled where it can be."""
    import yaml

    base: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

    class Loader(base):  # type: ignore[misc]
        def flatten_mapping(self, node: Any) -> None:
            """Before keys are merged: refuses one that is there twice, of which PyYAML takes the last."""
            known: set[tuple[str, str]] = set()
            for key, _ in () if hasattr(node, "is_merged") else node.value:
                if isinstance(key, yaml.ScalarNode) and (key.tag, key.value) in known:
                    text = f"the key {key.value!r} is there twice"
                    raise yaml.constructor.ConstructorError(None, None, text, key.start_mark)
                known.add((key.tag, str(key.value)))
            node.is_merged = True
            super().flatten_mapping(node)

    Loader.add_implicit_resolver("tag:yaml.org,2002:float", SHORT_REAL, list("-+0123456789"))
    return Loader
