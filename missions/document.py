"""A mission or study file as plain values that remember their line: YAML 1.2 in, dicts, lists and scalars out."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.reader import ReaderError

from missions.problems import Mark, MissionError, Path, Problem

_MISSION = "a YAML file with a mission: a mapping with at least a name"
_TAG = "tag:yaml.org,2002:"
_NO_TEXT = {"null", "bool", "int", "float"}
_PLAIN = {*_NO_TEXT, "str", "timestamp", "merge", "value", "map", "seq"}
# A longer number is no quantity of a mission, and Python refuses to print huge ones.
_LONGEST_SCALAR = 40


@dataclass(slots=True)
class Document:
    """The values of a file, where each was given, and what was wrong with the way they were written."""

    source: str
    values: dict[str, Any] = field(default_factory=dict)
    marks: dict[Path, Mark] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)

    def mark(self, path: Path) -> Mark:
        """Where the key was given, or else the nearest section around it."""
        while path and path not in self.marks:
            path = path[:-1]
        return self.marks.get(path, Mark(self.source))

    def value(self, path: Path) -> Any:
        """The value at `path`; None if a section on the way there is absent."""
        value: Any = self.values
        for key in path:
            value = step(value, key)
        return value

    def put(self, path: Path, value: Any, mark: Mark) -> None:
        """Set the value at `path`, and make the sections on the way there; `mark` says where all of it was given."""
        self.claim(path, mark)
        self._mark_inside(path, value, mark)
        section = self.values
        for depth, name in enumerate(path[:-1], start=1):
            inner = section.get(name)
            if not isinstance(inner, dict):
                inner = section[name] = {}
                self.marks[path[:depth]] = mark
            section = inner
        section[path[-1]] = value

    def claim(self, path: Path, mark: Mark) -> None:
        """Say that all at `path` was given at `mark`, whatever stood there before."""
        for known in [known for known in self.marks if known[: len(path)] == path]:
            del self.marks[known]
        self.marks[path] = mark

    def _mark_inside(self, path: Path, value: Any, mark: Mark) -> None:
        parts: Any = value.items() if isinstance(value, dict) else ()
        if isinstance(value, list):  # as a reader does it: items that are mappings are told apart
            parts = [(str(number), item) for number, item in enumerate(value) if isinstance(item, dict)]
        for name, inner in parts:
            self.marks[(*path, name)] = mark
            self._mark_inside((*path, name), inner, mark)

    def copy(self) -> Document:
        """The same document, to be changed apart from this one."""
        return Document(self.source, deepcopy(self.values), dict(self.marks), list(self.problems))


def step(value: Any, key: str) -> Any:
    """What lies at `key` of a mapping, or at that number of a list; None where nothing does."""
    if isinstance(value, dict):
        return value.get(key)
    inside = isinstance(value, list) and key.isdecimal() and int(key) < len(value)
    return value[int(key)] if inside else None


def read_document(data: bytes, *, source: str) -> Document:
    """The document in a file's bytes; `source` names the file in problems.

    Raises:
        MissionError: not UTF-8, not YAML, empty, or no mapping: nothing to look at key by key.
    """
    node = _compose(_decode(data, source), source)
    document = Document(source)
    if isinstance(node, MappingNode):
        values = _Reader(document, Mark(source, 1)).value(node, ())
        if values is None:  # a tag on the whole
            raise MissionError(document.problems)
        document.values = values
        return document
    got = "an empty file" if node is None else "a list" if isinstance(node, SequenceNode) else "a single value"
    raise MissionError([Problem(Mark(source), (), got, _MISSION)])


def read_value(document: Document, path: Path, text: str, *, mark: Mark) -> Any:
    """One value written as YAML, as it would stand at `path`; `mark` says where all of it was given."""
    node = _compose(text, mark.source, lines=False)
    document.claim(path, mark)
    return None if node is None else _Reader(document, mark, one_mark=True).value(node, path)


def _decode(data: bytes, source: str) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        got = f"byte 0x{data[error.start]:02x} at offset {error.start}, which is not UTF-8 text"
        raise MissionError([Problem(Mark(source), (), got, _MISSION)]) from error


def _compose(text: str, source: str, *, lines: bool = True) -> Node | None:
    """The text's tree of nodes, which, unlike a loaded value, know their lines and keep a key given twice."""

    def problem(got: str, allowed: str, *, line: int | None = None) -> MissionError:
        return MissionError([Problem(Mark(source, line if lines else None), (), got, allowed)])

    try:
        node: Node | None = YAML(typ="safe", pure=True).compose(text)
    except MarkedYAMLError as error:
        where = error.problem_mark or error.context_mark
        raise problem(f"bad YAML ({error.problem})", "YAML 1.2", line=where and where.line + 1) from error
    except ReaderError as error:
        got = f"a character YAML has no place for (U+{error.character:04X})"
        raise problem(got, "YAML 1.2", line=text.count("\n", 0, error.position) + 1) from error
    except (YAMLError, ValueError) as error:
        raise problem(f"bad YAML ({error})", "YAML 1.2") from error
    except RecursionError as error:
        raise problem("values nested hundreds of levels deep", _MISSION) from error
    return node


class _Reader:
    """Turns nodes into plain values, and notes marks and problems in the document."""

    def __init__(self, document: Document, mark: Mark, *, one_mark: bool = False) -> None:
        self._document = document
        self._mark = mark
        self._one_mark = one_mark
        self._seen: set[int] = set()
        self._scalars = YAML(typ="safe", pure=True).constructor

    def value(self, node: Node, path: Path) -> Any:
        # A composed alias is the anchored node itself, met again.
        if id(node) in self._seen:
            self._note(node, path, "a YAML alias", "a value written out")
            return None
        self._seen.add(id(node))
        if str(node.tag).removeprefix(_TAG) not in _PLAIN:
            self._note(node, path, f"the YAML tag {node.tag}", "plain values")
            return None
        if isinstance(node, MappingNode):
            return self._mapping(node, path)
        if isinstance(node, SequenceNode):
            return [self._item(item, (*path, str(number)), path) for number, item in enumerate(node.value)]
        return self._scalar(node)

    def _item(self, node: Node, own: Path, path: Path) -> Any:
        """An item of a list: mappings are told apart by their number, so that their keys have lines of their own."""
        if not isinstance(node, MappingNode):
            return self.value(node, path)
        self._document.marks[own] = self._mark_of(node)
        return self.value(node, own)

    def _mapping(self, node: MappingNode, path: Path) -> dict[str, Any]:
        values: dict[str, Any] = {}
        for key_node, value_node in node.value:
            if not isinstance(key_node, ScalarNode):
                self._note(key_node, path, "a key that is no word", "keys that are words")
                continue
            key = str(key_node.value)
            inner = (*path, key)
            if key in values:
                first = self._document.marks[inner].line
                got = "a second value" if first is None else f"a second value (the first is in line {first})"
                self._note(key_node, inner, got, "each key once")
                continue
            self._document.marks[inner] = self._mark_of(key_node)
            values[key] = self.value(value_node, inner)
        return values

    def _scalar(self, node: Node) -> Any:
        text = str(node.value)
        if str(node.tag).removeprefix(_TAG) not in _NO_TEXT or len(text) > _LONGEST_SCALAR:
            return text
        try:
            return self._scalars.construct_object(node)
        except (KeyError, ValueError):
            return text  # an explicit tag on a text of another kind: `!!int abc`

    def _mark_of(self, node: Node) -> Mark:
        return self._mark if self._one_mark else Mark(self._mark.source, node.start_mark.line + 1)

    def _note(self, node: Node, path: Path, got: str, allowed: str) -> None:
        self._document.problems.append(Problem(self._mark_of(node), path, got, allowed))
