"""Where a bracket closes, and how far the operands of an operator reach, in blanked C++ code."""

import re

OPENING, CLOSING = "([{", ")]}"
_STATEMENT_AFTER_BRACE = re.compile(r"\s*[\w(*\[]")


def closing(code, opening):
    """Where the bracket at `opening` is closed; the end of the code if nowhere."""
    depth = 0
    for position in range(opening, len(code)):
        if code[position] in OPENING:
            depth += 1
        elif code[position] in CLOSING:
            depth -= 1
            if depth == 0:
                return position
    return len(code)


def outermost(text):
    """`text` with whatever stands in brackets as blanks, every byte at its place."""
    out, depth = [], 0
    for byte in text:
        if byte in CLOSING:
            depth -= 1
        out.append(byte if depth == 0 or byte == "\n" else " ")
        if byte in OPENING:
            depth += 1
    return "".join(out)


def _ends_operand(code, position):
    """Whether the byte there, which is in no bracket, belongs to no operand of && and ||."""
    byte = code[position]
    if byte in ";,?":
        return True
    if byte == ":":
        return ":" not in (code[position - 1], code[position + 1 : position + 2])
    if byte == "=":
        return code[position - 1] not in "=!<>" and code[position + 1 : position + 2] != "="
    if byte == "}":
        return _STATEMENT_AFTER_BRACE.match(code, position + 1) is not None
    return byte == "n" and re.search(r"\breturn$|\bco_return$", code[max(0, position - 8) : position + 1]) is not None


def left_operand(code, start, operator):
    """Where the operand before `operator` at `start` begins, and whether it holds the same operator itself."""
    other = "||" if operator == "&&" else "&&"
    depth, same, position = 0, False, start - 1
    while position >= 0:
        byte = code[position]
        if depth == 0:
            pair = code[position - 1 : position + 1]
            if byte in OPENING or pair == other or _ends_operand(code, position):
                break
            same = same or pair == operator
        depth += (byte in CLOSING) - (byte in OPENING)
        position -= 1
    position += 1
    return position + len(code[position:start]) - len(code[position:start].lstrip()), same


def right_operand(code, end, operator):
    """Where the operand after `operator`, which ends at `end`, ends, and whether it holds the same operator itself."""
    other = "||" if operator == "&&" else "&&"
    depth, same, position = 0, False, end
    while position < len(code):
        byte = code[position]
        if depth == 0:
            pair = code[position : position + 2]
            if byte in CLOSING or pair == other or (byte != "}" and _ends_operand(code, position)):
                break
            same = same or pair == operator
        depth += (byte in OPENING) - (byte in CLOSING)
        position += 1
    return end + len(code[end:position].rstrip()), same
