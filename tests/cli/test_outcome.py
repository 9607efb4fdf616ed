from simconsole.cli.outcome import table


def test_columns_are_aligned_at_the_longest_name() -> None:
    assert table([("a", "1"), ("longer", "2 3")]) == "  a       1\n  longer  2 3"


def test_no_row_is_no_line() -> None:
    assert table([]) == ""
