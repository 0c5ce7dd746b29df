#!/usr/bin/python3
"""Writes the reference of the API as one HTML page, from the comments of the proto files.

usage: proto/reference/make.py OUTPUT.html [PROTO_ROOT]
"""

import collections
import dataclasses
import html
import itertools
import pathlib
import re
import subprocess
import sys

from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorSet, MethodOptions

PACKAGE = "axisgate.v1"
PROTO_ROOT = pathlib.Path(__file__).resolve().parent.parent
INTRODUCTION = """
This page describes every call of the gateway, with its messages and enums. All are in the protobuf package
`axisgate.v1`, so the full name of the call Move is `/axisgate.v1.StageService/Move`. A program connects to the Unix
socket of the daemon, such as `unix:/run/axisgate/axisgate.sock`, or over TCP to `host:port`; connections from other
machines use TLS. The rules that all services share, such as names, exact amounts, repeated requests, errors and
resuming, are in `proto/README.md`.

In a signature, "stream" means any number of messages, and "changes nothing" marks a call that only reads. A call that
fails returns a gRPC status whose details contain a Problem; "Fails with" is followed by its Reason. Comments name an
enum value without the prefix of its enum: FED is JOB_STATE_FED. At most one field of a "oneof" is set. A field that is
"optional" or has a message as its type can be unset, which differs from 0. Timestamp and Duration are the types of
`google.protobuf`. "Manual" means the controller's manual, "configuration" the daemon's configuration file.
"""
STYLE = """
:root { color-scheme: light dark; } :target { background: #fc04; }
body { font: 16px/1.45 sans-serif; max-width: 64em; margin: 2em auto; padding: 0 1em; }
h2 { border-bottom: 2px solid; margin-top: 2.5em; }
h3, h4 { margin: 1.8em 0 0.3em; } p, ul { margin: 0.4em 0; } div { margin-left: 2em; }
table { border-collapse: collapse; width: 100%; }
td { border-top: 1px solid #8886; padding: 0.3em 1em 0.3em 0; vertical-align: top; overflow-wrap: anywhere; }
td:not(:last-child) { width: 27%; } td small { opacity: 0.7; } td p { margin: 0; }
nav ul { columns: 16em; list-style: none; padding: 0; }
@media print { body { max-width: none; font-size: 10pt; } a { color: inherit; } h2, h3, h4 { break-after: avoid; } }
"""
# Kind of the items in each field of a descriptor.
KINDS = {"service": "service", "method": "rpc", "message_type": "message", "nested_type": "message",
         "enum_type": "enum", "field": "field", "value": "value"}
LIST_ITEM = re.compile(r"  \S|(F|Also f|Every RPC f)ails ")
NAME = re.compile(r"`([^`]+)`|(?<![\w:.\"])[A-Za-z]\w*(?:\.\w+)*")


class Html(str):
    """Text with everything escaped."""


def element(tag, *children, **attributes):
    """Returns an HTML element. Children that are not Html are escaped."""
    names = "".join(f' {name}="{html.escape(value)}"' for name, value in attributes.items())
    inside = "".join(child if isinstance(child, Html) else html.escape(child, quote=False) for child in children)
    return Html(f"<{tag}{names}>{inside}</{tag}>" + ("" if tag in ("a", "code", "small") else "\n"))


@dataclasses.dataclass(eq=False)
class Item:
    """A service, RPC, message, field, enum or value. Its name, such as "Motion.repeated", is its anchor."""
    name: str
    parent: str  # Name of the item that contains this item. Empty if none does.
    kind: str
    descriptor: object
    comment: str
    file: str


def type_name(descriptor, role="type_name"):
    """Returns the name of a field's type, or of an RPC's input_type or output_type. Empty if there is none."""
    return getattr(descriptor, role, "").removeprefix(f".{PACKAGE}.").removeprefix(".google.protobuf.")


def load(root):
    """Returns the descriptors of the API's files below `root`, with their comments."""
    protos = sorted(root.glob(f"{PACKAGE.replace('.', '/')}/*.proto"))
    command = ["protoc", f"-I{root}", "--include_source_info", "--include_imports", "--descriptor_set_out=/dev/stdout"]
    compiled = subprocess.run([*command, *protos], check=True, stdout=subprocess.PIPE).stdout
    return [file for file in FileDescriptorSet.FromString(compiled).file if file.package == PACKAGE]


def walk(descriptor, path=(), prefix=""):
    """Yields the path, name, kind and descriptor of everything in a descriptor."""
    for part, kind in KINDS.items():
        known = descriptor.DESCRIPTOR.fields_by_name.get(part)
        for index, child in enumerate(getattr(descriptor, part) if known else ()):
            child_path = (*path, known.number, index)
            is_map = kind == "message" and child.options.map_entry
            yield child_path, prefix + child.name, "map" if is_map else kind, child
            yield from walk(child, child_path, f"{prefix}{child.name}.")


def blocks(comment):
    """Yields (is_item, text) for each paragraph and list item of a comment. An unindented line ends a finished item."""
    is_item, text = False, ""
    for line in [*comment.splitlines(), ""]:
        line = line.removeprefix(" ")
        begins_item = bool(LIST_ITEM.match(line))
        ends_item = is_item and text.endswith(".") and not line.startswith("  ")
        if text and (begins_item or ends_item or not line.strip()):
            yield is_item, text
            text = ""
        if not text:
            is_item = begins_item
        text = f"{text} {line.strip()}".strip()


def may_be_name(word, before, after):
    """Reports whether a word without backquotes can be a name of the API rather than English or a gRPC code."""
    begins_sentence = not before or before.endswith(". ")
    if word.isupper():  # A gRPC code, which may have the name of a reason, is a sentence or precedes a colon.
        return not begins_sentence and not after.startswith(":")
    if "." in word or "_" in word:
        return True
    return word[0].isupper() and (not begins_sentence or sum(letter.isupper() for letter in word) > 1)


class Reference:
    """Items of the API, and their HTML."""

    def __init__(self, files):
        self.items = {}
        self.by_short_name = collections.defaultdict(list)
        for file in files:
            comments = {tuple(location.path): f"{location.leading_comments}\n{location.trailing_comments}"
                        for location in file.source_code_info.location}
            for path, name, kind, descriptor in walk(file):
                parent = name.rpartition(".")[0]
                item = self.items[name] = Item(name, parent, kind, descriptor, comments.get(path, ""), file.name)
                prefix = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", parent.rpartition(".")[2]).upper() + "_"
                for short_name in {descriptor.name, descriptor.name.removeprefix(prefix)}:
                    self.by_short_name[short_name].append(item)

    def select(self, *kinds, parent=None):
        """Returns the items of these kinds, in the order of the files; with `parent`, only those in that item."""
        return [item for item in self.items.values() if item.kind in kinds and parent in (None, item.parent)]

    def resolve(self, word, here, in_list):
        """Returns the nearest item with a name from the comment of `here`. None if there is none or several."""
        if "." in word:
            return self.items.get(word)
        named = self.by_short_name.get(word, [])
        types = [type_name(here.descriptor, role) for role in ("type_name", "input_type", "output_type")]
        scopes = [here.name, here.parent, here.parent.rpartition(".")[0], *types]
        choices = [[item for item in named if item.parent == scope] for scope in scopes if scope]
        if not word.islower() or "_" in word:
            reasons = [item for item in named if in_list and item.parent == "Reason"]
            choices += [reasons, [item for item in named if item.file == here.file], named]
        return next((choice[0] for choice in choices if len(choice) == 1), None)

    def link(self, name, label=None):
        """Returns a link to an item, or only its label if the page does not have it."""
        label = label or name
        return element("a", label, href=f"#{name}") if name in self.items else label

    def sentences(self, text, here, in_list):
        """Yields a text with links for the names that are resolved."""
        end = 0
        for match in NAME.finditer(text):
            yield text[end:match.start()]
            end = match.end()
            word = match[1] or match[0]
            label = element("code", word) if match[1] else word
            may_link = match[1] or may_be_name(word, text[:match.start()], text[end:])
            target = self.resolve(word, here, in_list) if may_link else None
            yield self.link(target.name, label) if target not in (None, here) else label
        yield text[end:]

    def comment(self, item):
        """Yields the paragraphs and lists of an item's comment."""
        for is_item, group in itertools.groupby(blocks(item.comment), key=lambda block: block[0]):
            lines = [element("li" if is_item else "p", *self.sentences(text, item, is_item)) for _, text in group]
            yield from [element("ul", *lines)] if is_item else lines

    def service(self, service):
        """Yields the section of a service."""
        yield element("h2", service.name, id=service.name)
        yield from self.comment(service)
        for rpc in self.select("rpc", parent=service.name):
            call = rpc.descriptor
            request, response = (self.link(type_name(call, role)) for role in ("input_type", "output_type"))
            reads_only = call.options.idempotency_level == MethodOptions.NO_SIDE_EFFECTS
            yield element("h3", call.name, id=rpc.name)
            yield element("p", "stream " * call.client_streaming, request, " → ", "stream " * call.server_streaming,
                          response, " · changes nothing" * reads_only)
            yield from self.comment(rpc)

    def type(self, item, heading="h3"):
        """Yields the section of a message or enum with its nested types."""
        yield element(heading, item.name, id=item.name)
        for role, title in (("input_type", "Request of "), ("output_type", "Response of ")):
            calls = [rpc for rpc in self.select("rpc") if type_name(rpc.descriptor, role) == item.name]
            yield from (element("p", title, self.link(rpc.name), ".") for rpc in calls)
        yield from self.comment(item)
        rows = [self.row(child) for child in self.select("field", "value", parent=item.name)]
        yield element("table", *rows) if rows else element("p", "No fields.")
        for nested in self.select("message", "enum", parent=item.name):
            yield element("div", *self.type(nested, "h4"))

    def row(self, item):
        """Returns the table row of a field or value."""
        descriptor = item.descriptor
        cells = [element("td", element("code", descriptor.name), " ", element("small", str(descriptor.number)))]
        if item.kind == "field":
            oneofs = self.items[item.parent].descriptor.oneof_decl
            in_oneof = descriptor.HasField("oneof_index") and not descriptor.proto3_optional
            label = f"oneof {oneofs[descriptor.oneof_index].name}: " if in_oneof else ""
            cells.append(element("td", label, *self.field_type(descriptor)))
        return element("tr", *cells, element("td", *self.comment(item)), id=item.name)

    def field_type(self, field):
        """Returns the type of a field, given its descriptor, as texts and links."""
        name = type_name(field)
        if name in self.items and self.items[name].kind == "map":
            key, value = self.items[name].descriptor.field
            return ["map<", *self.field_type(key), ", ", *self.field_type(value), ">"]
        repeated = field.label == FieldDescriptorProto.LABEL_REPEATED
        label = "repeated " if repeated else "optional " if field.proto3_optional else ""
        scalar = FieldDescriptorProto.Type.Name(field.type).removeprefix("TYPE_").lower()
        return [label, self.link(name) if name else scalar]

    def page(self):
        """Returns the whole page."""
        contents, sections = [element("h2", "Contents")], []
        for service in sorted(self.select("service"), key=lambda item: item.name):
            calls = [part for rpc in self.select("rpc", parent=service.name)
                     for part in (", ", self.link(rpc.name, rpc.descriptor.name))]
            contents.append(element("p", self.link(service.name), ": ", *calls[1:]))
            sections += self.service(service)
        for title, kind in (("Messages", "message"), ("Enums", "enum")):
            types = sorted(self.select(kind), key=lambda item: item.name)
            links = (element("li", self.link(item.name)) for item in types)
            contents += [element("h3", title), element("ul", *links)]
            sections += [element("h2", title), *(part for item in types if not item.parent for part in self.type(item))]
        title = f"Axisgate API reference: {PACKAGE}"
        head = element("head", Html('<meta charset="utf-8">'), element("title", title), element("style", Html(STYLE)))
        introduction = self.comment(Item("", "", "page", None, INTRODUCTION, ""))
        body = element("body", element("h1", title), *introduction, element("nav", *contents), *sections)
        return "<!DOCTYPE html>\n" + element("html", head, body, lang="en")


def main(output, root=PROTO_ROOT):
    """Writes the page of the proto files below `root`."""
    pathlib.Path(output).write_text(Reference(load(pathlib.Path(root))).page(), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*sys.argv[1:])
