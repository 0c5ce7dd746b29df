// A verb of axisctl: its words, help, options and function.
#pragma once

#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace axisgate::axisctl {

struct Options;
struct Session;

// Headings of `axisctl help`.
enum class Heading { looking, moving, stopping, raw, settings, mills, help };

// Each file of verbs has a table of these. A verb below another one, such as `token create`, comes after it.
struct Verb {
  std::string_view words = "";         // "move"; "token create": the verb `create` below `token`
  Heading heading = Heading::looking;  // unused for a verb below another one
  std::string_view description = "";   // one line of `axisctl help`
  std::string_view help = "";          // more text, below the options; may be empty
  // Shell commands, one per line; "until Ctrl-C" marks commands that do not end by themselves. May be empty.
  std::string_view examples = "";
  void (*add_options)(CLI::App&, Options&) = nullptr;  // null: no options
  // Runs the verb, and returns its exit code or throws Failure. Null: the verb needs no daemon, or only has verbs below
  // it.
  int (*run)(const Session&) = nullptr;
  int (*run_without_daemon)(const Options&) = nullptr;  // called instead of run
  bool waits = false;                                   // accepts --wait, and then runs under a lease: with_lease()
  bool has_json = true;                                 // accepts --json
};

// Returns all verbs. The headings of `axisctl help`, and the verbs below each heading, have this order. The examples
// can be run in this order, on a stage with at least 2 mm of travel on either side and a mill with the name in the
// examples.
std::vector<const Verb*> verbs();

}  // namespace axisgate::axisctl
