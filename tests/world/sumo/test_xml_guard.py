import pytest

from simconsole.values.errors import ProfileError
from simconsole.world.sumo.xml_guard import (
    MAX_ATTRIBUTES,
    MAX_CHILDREN,
    MAX_DEPTH,
    MAX_ELEMENTS,
    Element,
    read_elements,
    shown,
)

MANY_ATTRIBUTES = b"<net " + b" ".join(b"a%d=''" % number for number in range(1000)) + b"/>"


def elements(content: bytes) -> list[Element]:
    found: list[Element] = []
    read_elements(content, "f.xml", "net", found.append)
    return found


def test_children_of_the_root_come_whole_and_in_order() -> None:
    one, other = elements(b'<net a="1">\n<b c="2"><d e="3"/>text</b>\n<f/></net>')
    assert (one.name, one.line, one.attributes) == ("b", 2, {"c": "2"})
    assert [(part.name, part.attributes) for part in one.children] == [("d", {"e": "3"})]
    assert (other.name, other.line, other.children) == ("f", 3, [])


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b'<!DOCTYPE net [<!ENTITY a "aaa"><!ENTITY b "&a;&a;">]><net>&b;</net>', "line 1: <!DOCTYPE>: refused"),
        (b'<!DOCTYPE net SYSTEM "file:///etc/passwd"><net/>', "line 1: <!DOCTYPE>: refused"),
        (b"<net>\n" + b"<a>" * 100_000, f"line 2: <a>: nested more than {MAX_DEPTH} deep"),
        (b"<net>" + b"<a/>" * (MAX_ELEMENTS + 1) + b"</net>", f"<a>: more than {MAX_ELEMENTS} elements"),
        (b"<net><e>" + b"<a/>" * (MAX_CHILDREN + 1) + b"</e></net>", f"<a>: more than {MAX_CHILDREN} elements in one"),
        (MANY_ATTRIBUTES, f"<net>: 1000 attributes: at most {MAX_ATTRIBUTES}"),
        (b"<other/>", "line 1: <other>: value other: <net> as the first element"),
        (b"", "line 1: not XML: no element found"),
        (b"<net>\n<a></net>", "line 2: not XML: mismatched tag"),
        (b"<net>&unknown;</net>", "line 1: not XML: undefined entity"),
        (b'<?xml version="1.0" encoding="x-nonsense"?><net/>', "line 1: not XML: unknown encoding"),
        (b"\xff\xff\xff", "line 1: not XML"),
    ],
)  # fmt: skip
def test_hostile_text_is_refused_in_one_line_with_its_element(content: bytes, told: str) -> None:
    with pytest.raises(ProfileError) as caught:
        elements(content)
    assert str(caught.value).startswith("f.xml: ")
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


def test_words_of_a_stranger_are_shown_short_and_printable() -> None:
    assert shown("a\n\u202eb") == "a\\n\\u202eb"
    assert len(shown("x" * 10_000)) == 40
