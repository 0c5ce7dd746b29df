// Texts of `axisctl help` besides the options, with working examples. A test runs every example, in order.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

struct HelpTopic {
  std::string_view name;      // verb or other topic; empty: axisctl as a whole
  std::string_view text;      // may be empty
  std::string_view examples;  // shell commands, one a line; "until Ctrl-C" marks commands that do not end by themselves
};

// Returns the topics in an order in which their examples can be run, on a stage with at least 2 mm of travel on either
// side and a mill with the name in the examples.
std::span<const HelpTopic> help_topics();

// Returns the text, then the examples; empty if there is no such topic.
std::string help_text(std::string_view topic);

// Returns the text, then the examples. Both may be empty.
std::string text_of(std::string_view text, std::string_view examples);

}  // namespace axisgate::axisctl
