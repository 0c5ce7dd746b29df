// The questions: *IDN? !: Q: SRQ: I: and all that begin with ?: (manual 1) to 44), 95)).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/simulator/commands/reader.h"
#include "device/shrc203/simulator/rig.h"

namespace axisgate::shrc203::simulator {

// Reports whether the line is a question, well formed or not.
bool is_question(std::string_view line);

// Returns the answer; nullopt for NG. `line` is in upper case and has no blanks.
std::optional<std::string> answer(const Rig& rig, std::string_view line);

// Answers !: !:S Q: Q:S SRQ: SRQ:S (manual 2) to 7)).
std::optional<std::string> answer_status(const Rig& rig, std::string_view line);

// Answers the questions that exist in HIT format.
std::optional<std::string> answer_in_hit_format(const Rig& rig, std::string_view line);

// Answers ?:M and the other registers of the two buffers (manual 18) to 25), 28), 29), 31)). `arguments` follows the
// name.
std::optional<std::string> answer_register(const Rig& rig, std::string_view name, Reader arguments);

// Joins one field for each named axis, separated by commas.
template <class Field>
std::string join_fields(const Axes& axes, Field field) {
  std::string text;
  for (const int axis : axes.list()) {
    if (!text.empty()) text += ',';
    text += field(axis);
  }
  return text;
}

}  // namespace axisgate::shrc203::simulator
