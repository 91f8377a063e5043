"""The JSON Schema of mission files, for editors: keys with their descriptions, limits and defaults."""

from __future__ import annotations

from typing import Any

from missions.mission import Mission


def mission_schema() -> dict[str, Any]:
    """The schema (draft 2020-12). The rules between keys are beyond it: `swarm check` knows them."""
    schema = Mission.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_plain(schema)}


def _plain(node: Any) -> Any:
    """The same schema with `anyOf` for `oneOf`: a section that names no kind is the default kind, but may fit two."""
    if isinstance(node, dict):
        return {"anyOf" if key == "oneOf" else key: _plain(value) for key, value in node.items()}
    return [_plain(item) for item in node] if isinstance(node, list) else node
