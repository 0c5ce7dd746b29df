"""Hints name calls of the API, and axisctl has a command for each."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))

import hints  # noqa: E402
from tree import File  # noqa: E402

PROTO = File("proto/axisgate/v1/stage.proto", "  rpc Stop(StopRequest) returns (StopResponse);\n  rpc Jog(J) returns (K);\n")
TABLE = File(hints.TABLE, '{"`Stop`", "stop"},\n')


def findings(line, path="server/api/a.cc", table=TABLE):
    return [finding.what for finding in hints.check_all([PROTO, table, File(path, f"{line}\n")])]


class Hints(unittest.TestCase):
    def test_a_call_with_a_command_is_well_named(self):
        self.assertEqual(findings('fail("or stop it: `Stop`");'), [])

    def test_a_call_without_a_command_is_found(self):
        self.assertEqual(findings('fail("use `Jog`");'), ["axisctl has no command for `Jog`"])

    def test_a_call_that_the_api_does_not_have_is_found(self):
        self.assertEqual(findings('fail("use `Halt`");'), ["`Halt` is no call of the API"])
        self.assertEqual(findings("", table=File(hints.TABLE, '"`Halt`"')), ["`Halt` is no call of the API"])

    def test_a_command_of_axisctl_is_found_where_callers_read(self):
        for text in ("see `axisctl stop`", "to wait, add --wait SECONDS"):
            self.assertEqual(findings(f'fail("{text}");'), ["a text for callers is about axisctl"])
        self.assertEqual(findings('fail("see `axisctl stop`");', path=hints.OWN[0]), [])
        self.assertEqual(findings("// As axisctl does."), [])


if __name__ == "__main__":
    unittest.main()
