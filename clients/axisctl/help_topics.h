// What `axisctl help` says beside the options, with examples that work. A test runs every one of them, in their order.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

struct HelpTopic {
  std::string_view name;      // a verb or another topic; empty: axisctl as a whole
  std::string_view text;      // may be empty
  std::string_view examples;  // lines for a shell; they end with "until Ctrl-C" where they do not end by themselves
};

// In the order in which the examples can be run, on a stage with at least 2 mm of travel on either side, and
// on a mill with that name.
std::span<const HelpTopic> help_topics();

// The text, then the examples; empty when there is no such topic.
std::string help_text(std::string_view topic);

}  // namespace axisgate::axisctl
