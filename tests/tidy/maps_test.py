"""Each rule about pages finds a page that lies, and leaves one that does not."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))

import maps  # noqa: E402
from tree import File  # noqa: E402


def findings(**files):
    """The rules broken in a tree of these files, by path with "__" for a slash and "_DOT_" for a dot."""
    tree = [File(path.replace("__", "/").replace("_DOT_", "."), content) for path, content in files.items()]
    return [str(finding).split(": ")[1] for finding in maps.check_all(tree)]


class Names(unittest.TestCase):
    def test_what_exists_may_be_named(self):
        page = "`server/a.cc`, `server/a.*`, `server/`, `a.cc`, `a.*`, `x/b`, [the file](server/a.cc#part)\n"
        self.assertEqual(findings(README_DOT_md=page, server__a_DOT_cc=""), [])

    def test_what_does_not_exist_is_found(self):
        for name in ("`server/b.cc`", "`server/b.*`", "`server/b/`", "`b.cc`", "`b.*`", "[the file](server/b.cc)"):
            self.assertEqual(findings(README_DOT_md=name + "\n", server__a_DOT_cc=""), ["map-path"], name)


    def test_a_table_names_files_below_its_page(self):
        row = "| `a.*` | what it does |\n"
        self.assertEqual(findings(server__README_DOT_md=row, server__log__a_DOT_cc="", device__a_DOT_cc=""),
                         ["map-folders"])
        self.assertEqual(findings(server__log__README_DOT_md=row, device__a_DOT_cc=""), ["map-path"])


class Folders(unittest.TestCase):
    def test_each_folder_is_in_its_page(self):
        self.assertEqual(findings(device__README_DOT_md="`core/`\n", device__core__a_DOT_h=""), [])
        self.assertEqual(findings(device__README_DOT_md="`score/`\n", device__core__a_DOT_h=""), ["map-folders"])


class Floors(unittest.TestCase):
    def test_the_overview_says_the_floors(self):
        controller = "types < command < {planning, recording} < state < session < motion < transaction"
        right = f"core/ link/ rpc/ core < link < server < server/rpc < clients\nevents/ events\ntypes < command < line\n{controller}\n"
        tree = {"device__core__a_DOT_h": "", "device__link__a_DOT_h": "", "server__rpc__a_DOT_h": "",
                "server__events__a_DOT_h": ""}
        self.assertEqual(findings(docs__developing_DOT_md=right, **tree), [])
        wrong = right.replace("core < link", "{core, link}")
        self.assertEqual(findings(docs__developing_DOT_md=wrong, **tree), ["map-floors"])


class Threads(unittest.TestCase):
    def test_each_thread_is_in_the_list(self):
        for member in ("std::thread thread_;", "std::unique_ptr<boost::asio::thread_pool> thread_;"):
            page = "`journal/`, `journal/a.*`\n"
            self.assertEqual(findings(server__README_DOT_md=page, server__journal__a_DOT_h=member), [])
            self.assertEqual(findings(server__README_DOT_md="`journal/`\n", server__journal__a_DOT_h=member),
                             ["map-threads"])


class Alerts(unittest.TestCase):
    def test_the_table_has_each_alert(self):
        rules = "rules:\n  - alert: AxisgateDown\n    expr: up == 0\n  - alert: AxisgateStopOpen\n"
        right = "| `AxisgateDown` | x |\n| `AxisgateStopOpen` | x |\n"
        tree = {"deploy__prometheus__alerts_DOT_yml": rules}
        self.assertEqual(findings(docs__container_DOT_md=right, **tree), [])
        for wrong in ("| `AxisgateDown` | x |\n", right + "| `AxisgateUp` | x |\n", "\n".join(right.split("\n")[::-1])):
            self.assertEqual(findings(docs__container_DOT_md=wrong, **tree), ["map-alerts"], wrong)


if __name__ == "__main__":
    unittest.main()
