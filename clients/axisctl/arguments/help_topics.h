// Texts of `axisctl help` about no single verb, with working examples. A test runs every example, in order.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

struct HelpTopic {
  std::string_view name;  // empty: axisctl as a whole
  std::string_view text;
  std::string_view examples;  // as Verb::examples
};

// Returns the topics in an order in which their examples can be run after those of the verbs.
std::span<const HelpTopic> help_topics();

// Returns the text and examples of a topic; empty if there is no such topic.
std::string topic_text(std::string_view topic);

// Returns the text, then the examples. Both may be empty.
std::string help_text(std::string_view text, std::string_view examples);

}  // namespace axisgate::axisctl
