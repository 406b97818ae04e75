"""What commands are given: types in their short and full form, values in the place of a type."""

from __future__ import annotations

import pytest

from simkit.errors import InputError
from simkit_terminal.cli.terminal.message_arguments import check_type, is_same_type, split_type_and_values


@pytest.mark.parametrize("said", ["std_srvs/srv/Empty", "std_srvs/Empty"])
def test_a_type_can_be_given_in_full_or_short(said: str) -> None:
    assert is_same_type(said, "std_srvs/srv/Empty")
    check_type(said, ["std_msgs/msg/Bool", "std_srvs/srv/Empty"], "/thing")


@pytest.mark.parametrize("said", ["std_srvs", "std_srvs/msg/Empty", "std_srvs/srv/Empty/more/words", "Empty", ""])
def test_another_type_is_rejected(said: str) -> None:
    with pytest.raises(InputError, match=r"SK-CLI-032 /thing has type std_srvs/srv/Empty, found '"):
        check_type(said, ["std_srvs/srv/Empty"], "/thing")


def test_values_alone_stand_in_the_place_of_the_type() -> None:
    assert split_type_and_values("{data: true}", None) == (None, "{data: true}")
    assert split_type_and_values("std_srvs/SetBool", None) == ("std_srvs/SetBool", None)
    assert split_type_and_values("std_srvs/SetBool", "{}") == ("std_srvs/SetBool", "{}")
