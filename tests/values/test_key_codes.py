"""The mask of held keys: one bit each, and exactly a float, as the slot that carries it is."""

from simconsole.values.key_codes import Key


def test_each_key_has_a_bit_of_its_own_and_all_at_once_are_a_float_exactly() -> None:
    bits = [int(key) for key in Key]
    assert bits == [1 << place for place in range(len(Key.__members__))]
    assert Key(int(float(sum(bits)))) == ~Key(0)
