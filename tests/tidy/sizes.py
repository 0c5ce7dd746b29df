"""Files and functions stay small enough to be read at once."""

import cpp

FILE_LINES_MAX = 400
FUNCTION_LINES_MAX = 70


def check(file, _files):
    if not file.language or file.generated:
        return
    if len(file.lines) > FILE_LINES_MAX:
        yield file.finding(FILE_LINES_MAX + 1, "file-size", f"{len(file.lines)} lines, more than {FILE_LINES_MAX}",
                           "split it where its reasons to change part")
    if file.language == "C++":
        yield from _check_functions(file)


def _check_functions(file):
    try:
        functions = cpp.functions("\n".join(file.code))
    except cpp.Unbalanced as at:
        yield file.finding(int(str(at)), "braces", "a brace or parenthesis has no partner, and hides functions",
                           "balance it, also in each branch of an #if")
        return
    for function in functions:
        if function.body_lines > FUNCTION_LINES_MAX:
            yield file.finding(function.line, "function-size",
                               f"{function.name} has {function.body_lines} lines, more than {FUNCTION_LINES_MAX}",
                               "name its steps and make them functions")
