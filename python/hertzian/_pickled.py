"""How models are made again where they have been pickled or copied."""

from __future__ import annotations

from ._hertzian import Model


def model(text: str, values: dict[str, float]) -> Model:
    """The model of a text at values of its parameters, of which those without one are left out."""
    return Model(text, **{name: value for name, value in values.items() if value == value})
