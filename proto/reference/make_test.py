"""Tests of make.py: the page of a small proto file, and the anchors, links and comments of the page of the API."""

import collections
import html
import pathlib
import re
import tempfile
import unittest

import make

SAMPLE = """
syntax = "proto3";
package axisgate.v1;
service DoorService {
  // Opens a door
  // & waits.
  //
  // Second paragraph, see `wood` and `wood_cost`.
  // Fails with STUCK if <nothing>
  // moves.
  // Fails with OTHER if Door.size is 0.
  // The end.
  rpc Open(stream Door) returns (stream Door);
  // See Open, Door.missing and STUCK.
  rpc Look(Door) returns (Door) {
    option idempotency_level = NO_SIDE_EFFECTS;
  }
}
message Door {
  oneof material {
    int64 wood = 1;
    Reason steel = 2;
  }
  optional int32 size = 3; // Trailing comment.
  repeated Door doors = 4;
  map<string, Reason> reasons = 5;
}
enum Reason {
  REASON_UNSPECIFIED = 0;
  // UNKNOWN: it does not move. STUCK.
  REASON_STUCK = 1;
}
"""


class Page(unittest.TestCase):
    def test_sample_has_these_parts(self):
        with tempfile.TemporaryDirectory() as folder:
            output, file = pathlib.Path(folder, "page.html"), pathlib.Path(folder, "axisgate/v1/sample.proto")
            file.parent.mkdir(parents=True)
            file.write_text(SAMPLE, encoding="utf-8")
            make.main(output, folder)
            page = output.read_text(encoding="utf-8")
        door, reason = '<a href="#Door">Door</a>', '<a href="#Reason">Reason</a>'
        stuck, wood = '<a href="#Reason.REASON_STUCK">STUCK</a>', '<a href="#Door.wood"><code>wood</code></a>'
        for part in (
                f'<h3 id="DoorService.Open">Open</h3>\n<p>stream {door} → stream {door}</p>\n'
                f'<p>Opens a door &amp; waits.</p>\n<p>Second paragraph, see {wood} and <code>wood_cost</code>.</p>\n'
                f'<ul><li>Fails with {stuck} if &lt;nothing&gt; moves.</li>\n'
                '<li>Fails with OTHER if <a href="#Door.size">Door.size</a> is 0.</li>\n</ul>\n<p>The end.</p>\n',
                f'<h3 id="DoorService.Look">Look</h3>\n<p>{door} → {door} · changes nothing</p>\n'
                f'<p>See <a href="#DoorService.Open">Open</a>, Door.missing and {stuck}.</p>\n',
                f'<h3 id="Door">Door</h3>\n<p>Request of <a href="#DoorService.Open">DoorService.Open</a>.</p>\n',
                '<tr id="Door.wood"><td><code>wood</code> <small>1</small></td>\n<td>oneof material: int64</td>\n<td>',
                f'<td>oneof material: {reason}</td>\n',
                '<td>optional int32</td>\n<td><p>Trailing comment.</p>\n</td>\n</tr>\n',
                f'<td>repeated {door}</td>\n', f'<td>map&lt;string, {reason}&gt;</td>\n',
                '<tr id="Reason.REASON_STUCK"><td><code>REASON_STUCK</code> <small>1</small></td>\n'
                '<td><p>UNKNOWN: it does not move. STUCK.</p>\n</td>\n</tr>\n'):
            self.assertIn(part, page)

    def test_page_of_the_api_is_complete(self):
        page = make.Reference(make.load(make.PROTO_ROOT)).page()
        files = [path.read_text(encoding="utf-8") for path in make.PROTO_ROOT.glob("axisgate/v1/*.proto")]
        anchors = re.findall(r' id="([^"]+)"', page)
        self.assertEqual(len(anchors), len(set(anchors)))
        self.assertLessEqual(set(re.findall(r'href="#([^"]+)"', page)), set(anchors))

        names = re.findall(r"^ *(?:service|rpc|message|enum) (\w+)", "\n".join(files), re.MULTILINE)
        short_names = collections.Counter(anchor.rpartition(".")[2] for anchor in anchors)
        self.assertLessEqual(collections.Counter(names), short_names)

        text = " ".join(html.unescape(re.sub(r"<[^>]*>", "", page)).split())
        for file in files:
            for line in re.findall(r"^ *// *(.*\S)", file.partition("syntax =")[2], re.MULTILINE):
                self.assertIn(" ".join(line.replace("`", "").split()), text)


if __name__ == "__main__":
    unittest.main()
