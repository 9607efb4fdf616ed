from tests.drives.console import complaint, results, simconsole


def test_devices_list_shows_a_virtual_cockpit() -> None:
    done = simconsole("devices", "list", "--virtual", "--json")
    assert done.returncode == 0, done.stderr
    assert {device["usb_id"]: device["roles"] for device in results(done)["devices"]} == {
        "044f:b65e": ["wheel", "pedals"],
        "044f:b660": ["shifter"],
    }
    assert "044f:b65e" in done.stdout


def test_devices_list_without_a_cockpit_fails_and_says_so() -> None:
    done = simconsole("devices", "list")
    assert done.returncode == 1
    assert "nothing connected for wheel, pedals, shifter" in done.stdout


def test_devices_check_without_a_cockpit_is_one_line() -> None:
    assert "044f:b65e" in complaint(simconsole("devices", "check", "--for", 1))
