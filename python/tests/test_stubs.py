"""What the stubs for type checkers say is there, and nothing else."""

import ast
import doctest
import pathlib

import hertzian
from hertzian import _hertzian

STUBS = pathlib.Path(hertzian.__file__).with_name("_hertzian.pyi")


def declared():
    """The members of each class in the stubs."""
    tree = ast.parse(STUBS.read_text())
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    return {node.name: {item.name for item in node.body if isinstance(item, ast.FunctionDef)} for node in classes}


def is_public(name):
    return not name.startswith("_")


def test_stubs_have_what_the_module_has():
    stubs = declared()
    classes = {name: found for name, found in vars(_hertzian).items() if isinstance(found, type)}
    assert set(stubs) == set(classes)
    for name, found in classes.items():
        assert set(filter(is_public, stubs[name])) == set(filter(is_public, vars(found))), name


def test_all_that_is_public_is_documented_and_exported():
    for name in hertzian.__all__:
        assert getattr(hertzian, name).__doc__, name
    for found in vars(_hertzian).values():
        if isinstance(found, type):
            assert found.__name__ in hertzian.__all__
            assert found.__module__ == "hertzian"
            for name in filter(is_public, vars(found)):
                assert getattr(found, name).__doc__, f"{found.__name__}.{name}"
    assert (STUBS.parent / "py.typed").exists()


def test_the_lines_of_the_documentation_print_what_is_said():
    result = doctest.testmod(hertzian)
    assert result.attempted >= 4 and result.failed == 0
