"""The server's durations have one place, and a controller has its own."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))

import includes  # noqa: E402
from tree import File  # noqa: E402

LIMITS = ("constexpr Duration kPause = std::chrono::seconds(2);", "static constexpr auto kLife = std::chrono::days(9);",
          "inline constexpr std::chrono::milliseconds kWait{std::chrono::seconds(1)};")


def findings(path, line):
    file = File(path, f"{line}\n")
    return [str(finding).split(": ")[1] for finding in includes.check(file, [file])]


class ServerLimits(unittest.TestCase):
    def test_a_duration_has_one_place(self):
        for limit in LIMITS:
            self.assertEqual(findings("server/devices/a.cc", limit), ["server-limit"], limit)
            self.assertEqual(findings("server/limits.h", limit), [], limit)

    def test_a_controller_has_its_own(self):
        for limit in LIMITS:
            self.assertEqual(findings("device/shrc203/a.cc", limit), [], limit)


if __name__ == "__main__":
    unittest.main()
