#include "clients/axisctl/hints.h"

#include <fmt/format.h>

namespace axisgate::axisctl {
namespace {

struct Row {
  std::string_view call;
  std::string_view command;  // "{}" is the axis
};

// Fields that are options of several commands.
constexpr Row kOptions[] = {
    {"`accepted_warnings`", "--accept"},
    {"acquire a lease with `wait`", "add --wait SECONDS"},
    {"set a later `not_after`", "add --wait SECONDS"},
};

// A call with a field comes before the same call alone.
constexpr Row kRows[] = {
    {"`AbortJob`", "mill abort"},
    {"`AcquireLease`", "lease run"},
    {"`CancelJob`", "mill cancel"},
    {"`CancelJobs`", "mill clear"},
    {"`ChangeSettings` with `divisions`", "divisions"},
    {"`ChangeSettings` with `excited`", "motor {} on"},
    {"`ChangeSettings` with `sleeping`", "wake"},
    {"`ChangeSettings` with `speeds`", "speed {} --minimum ... --maximum ..."},
    {"`ChangeSettings` with `trigger`", "trigger off"},
    {"`ClearErrors`", "clear"},
    {"`ConfirmJob`", "mill confirm"},
    {"`CreateToken`", "token create"},
    {"`DeletePosition`", "forget"},
    {"`Execute`", "exec"},
    {"`GetDevice`", "status"},
    {"`GetMill`", "mill queue"},
    {"`Home`", "home {}"},
    {"`Jog`", "jog"},
    {"`ListCommands`", "commands"},
    {"`ListHistory`", "history"},
    {"`ListMotions`", "motions"},
    {"`ListPositions`", "positions"},
    {"`ListTokens`", "token list"},
    {"`Move`", "move {}=..."},
    {"`MoveJob`", "mill first"},
    {"`PauseJob` with `raise_tool`", "mill pause --raise"},
    {"`Rearm`", "rearm"},
    {"`RepeatJob` without `rest`", "mill again"},
    {"`ReportJobDone`", "mill done"},
    {"`ResetDevice`", "reset"},
    {"`ResumeJob`", "mill resume"},
    {"`SavePosition`", "save"},
    {"`SendJob`", "mill send"},
    {"`SetCoordinates`", "zero {}"},
    {"`Stop`", "stop"},
    {"`WatchLeases`", "lease list"},
    {"`WatchMill`", "mill watch"},
};

void replace_all(std::string& text, std::string_view old, std::string_view replacement) {
  for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + replacement.size())) {
    text.replace(at, old.size(), replacement);
  }
}

}  // namespace

std::string with_commands(std::string_view hint, int axis) {
  const std::string name = axis == 0 ? "AXIS" : std::to_string(axis);
  std::string text(hint);
  for (const auto& [call, command] : kRows) {
    replace_all(text, call, fmt::format("`axisctl {}`", fmt::format(fmt::runtime(command), name)));
  }
  for (const auto& [field, option] : kOptions) replace_all(text, field, option);
  return text;
}

}  // namespace axisgate::axisctl
