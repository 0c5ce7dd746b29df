#include "clients/cpp/src/hints.h"

#include <fmt/format.h>

namespace axisgate::client {
namespace {

struct HintRow {
  std::string_view call;
  std::string_view function;  // "{}" is the axis
};

// A call with a field comes before the same call alone.
constexpr HintRow kHints[] = {
    {"`AcquireLease`", "`stage.lease({{.axes = {{{}}}}})`"},
    {"`ChangeSettings` with `excited`", "`stage.switch_motor({}, true)`"},
    {"`ChangeSettings` with `speeds`", "`stage.set_speeds({}, ...)`"},
    {"`ClearErrors`", "`stage.clear_errors()`"},
    {"`DeletePosition`", "`stage.places().erase(name)`"},
    {"`Execute`", "`stage.execute({{line}})`"},
    {"`GetDevice`", "`stage.status()`"},
    {"`Home`", "`stage.home({{{}}})`"},
    {"`Jog`", "`stage.jog(...)`"},
    {"`ListMotions`", "`stage.motions()`"},
    {"`ListPositions`", "`stage.places().list()`"},
    {"`Move`", "`stage.move_to(...)`"},
    {"`Rearm`", "`stage.rearm()`"},
    {"`SavePosition`", "`stage.places().save(name)`"},
    {"`Stop`", "`stage.stop()`"},
};

}  // namespace

std::string with_functions(std::string_view hint, std::optional<int> axis) {
  const std::string name = axis ? fmt::format("\"{}\"", *axis) : "axis";
  std::string text(hint);
  for (const auto& [call, function] : kHints) {
    const std::string replacement = fmt::format(fmt::runtime(function), name);
    for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + replacement.size())) {
      text.replace(at, call.size(), replacement);
    }
  }
  return text;
}

}  // namespace axisgate::client
