// A model of the family as data: what the line and the commands must know about one controller.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/shot/command/command.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

// Questions that the line itself asks. Every model answers them.
enum class LineQuestion {
  identity,     // 1) *IDN?
  line_before,  // 40) ?:CMD
  ready,        // 2) !:
  each_ready,   // 3) !:S
};
std::string_view text(LineQuestion question);

// A line that a program stored in the controller sends by itself. It is never a reply.
struct Notice {
  std::string_view text;
  ProgramNotice::Kind kind;
};

// A Model never changes. It may be used from any thread.
class Model {
 public:
  // `commands` must have a row for each LineQuestion, and names that are valid as long as the program runs.
  Model(std::string_view name, int axis_count, std::vector<CommandRow> commands, std::vector<Notice> notices);
  Model(const Model&) = delete;  // commands refer to its rows
  Model& operator=(const Model&) = delete;

  std::string_view name() const { return name_; }  // model that *IDN? reports
  AxisSet axes() const { return AxisSet::first(axis_count_); }
  int axis_count() const { return axis_count_; }
  std::span<const CommandRow> commands() const { return commands_; }
  std::optional<ProgramNotice::Kind> notice(std::string_view line) const;

  const Command& ask(LineQuestion question) const { return questions_[static_cast<std::size_t>(question)]; }

  // Returns the row with that name, which must exist. For the folder of the model's table and tests: other code uses
  // commands by their meaning, and decides by the attributes of their rows.
  const CommandRow& row(std::string_view name) const;
  // Make a command, for the same folder and tests. The arguments must fit: an error here is a defect and aborts.
  Command make(std::string_view name, const Arguments& arguments = {}) const;
  Command make(std::string_view name, AxisSet axes) const { return make(name, Arguments().axes(axes)); }
  static Command make(const CommandRow& row, const Arguments& arguments);

  // Parses a line that a caller wrote. Fails with malformed_line for control or non-ASCII characters (also CR, LF,
  // NUL), for more than 200 characters, and for a known command in another form; with unknown_command; with
  // out_of_range.
  Result<Command> parse(std::string_view text) const;

 private:
  const CommandRow* begun_by(std::string_view text) const;

  const std::string_view name_;
  const int axis_count_;
  const std::vector<CommandRow> commands_;
  const std::vector<Notice> notices_;
  const std::vector<Command> questions_;  // by LineQuestion
};

}  // namespace axisgate::shot
