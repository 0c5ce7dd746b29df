#include "tests/conformance/verification.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "device/shot/command/command.h"
#include "device/shot/command/reply.h"
#include "device/shrc203/command/command_table.h"
#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::conformance {
namespace {

using simulator::SimulatorBench;

Result<simulator::Options> options_of(const Entry& entry) {
  simulator::Options options;
  for (const auto& [name, value] : entry.device) {
    if (name == "axis_setting") {
      const auto setting = from_axis_setting(value);
      if (!setting) return fail(Reason::invalid_request, "axis_setting is a digit from 0 to 6");
      options.axis_setting = value.front() - '0';
    } else if (auto set = options.set(name, value); !set) {
      return tl::unexpected(set.error());
    }
  }
  return options;
}

Arguments arguments_of(const Entry& entry) {
  Arguments arguments;
  for (const auto& [letter, value] : entry.meaning) arguments.add(letter, value);
  return arguments;
}

Complaint check_command(const Entry& entry, const CommandRow& row) {
  const Arguments arguments = arguments_of(entry);
  const auto line = encode(row, arguments);
  if (!line) return "its meaning does not encode: " + line.error().message;
  if (*line != entry.sent) return fmt::format("its meaning encodes to '{}'", *line);
  const auto command = model().parse(entry.sent);
  if (!command) return "the line is refused: " + command.error().message;
  if (command->row != &row) return fmt::format("the line is read as {}", command->row->name);
  if (command->arguments != arguments) return "the line is read with another meaning";
  if (command->line != entry.sent) return fmt::format("the strict line is '{}'", command->line);
  return {};
}

// Removes the blanks that pad a coordinate between sign and digits (manual 4) Q:).
std::string without_filling(std::string field) {
  if (field.starts_with('+') || field.starts_with('-')) std::erase(field, ' ');
  return field;
}

Complaint check_reply(const Entry& entry, const CommandRow& row, int axis_count) {
  const auto reply = parse_reply(model(), row, entry.reply, axis_count);
  if (!reply) return fmt::format("'{}' is refused as an answer", entry.reply);
  const bool is_word = reply->kind != Reply::Kind::data;
  if (is_word != is_answer_word(entry.reply)) return fmt::format("'{}' is taken for another kind", entry.reply);
  if (is_word) return {};
  std::vector<std::string> fields;
  std::ranges::transform(reply->fields, std::back_inserter(fields), without_filling);
  const auto& expected = entry.fields.empty() ? std::vector{entry.reply} : entry.fields;
  if (fields != expected) return fmt::format("the reply's fields are read as {}", fmt::join(fields, " | "));
  return {};
}

bool is_axis_number(std::string_view line) { return line == "1" || line == "2" || line == "3"; }

// Returns all lines from `first` on, each with a newline.
std::string said_since(const SimulatorBench& bench, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < bench.said().size(); ++i) text += bench.said()[i].line + "\n";
  return text;
}

Complaint bring_into_state(const Entry& entry, SimulatorBench& bench) {
  for (const auto& [line, reply] : entry.setup) {
    const auto first = bench.said().size();
    bench.ask(line);
    if (said_since(bench, first) != reply + "\n") {
      return fmt::format("setup '{}' was answered by '{}'", line, said_since(bench, first));
    }
  }
  if (!entry.wait_until_ready) return {};
  const auto first = bench.said().size();
  bench.rest();
  if (bench.device.busy(1) || bench.device.busy(2) || bench.device.busy(3)) return "the setup never ends";
  for (std::size_t i = first; i < bench.said().size(); ++i) {
    if (!is_axis_number(bench.said()[i].line)) return fmt::format("the setup said '{}'", bench.said()[i].line);
  }
  return {};
}

}  // namespace

Complaint check_by_table(const Entry& entry) {
  const auto row = std::ranges::find(model().commands(), entry.row, &CommandRow::name);
  if (row == model().commands().end()) return fmt::format("the table has no row '{}'", entry.row);
  if (row->section != entry.section) return fmt::format("the table has section {} for it", row->section);
  const auto options = options_of(entry);
  if (!options) return options.error().message;
  if (auto complaint = check_command(entry, *row)) return complaint;
  // A question that names axes is answered only for them, as if the controller had no other axes.
  const auto controllable = *from_axis_setting(std::to_string(options->axis_setting));
  return check_reply(entry, *row, model().parse(entry.sent)->axes(controllable).count());
}

Complaint check_by_simulator(const Entry& entry) {
  if (entry.offline) return {};
  const auto options = options_of(entry);
  if (!options) return options.error().message;
  SimulatorBench bench({}, *options);
  if (auto complaint = bring_into_state(entry, bench)) return complaint;
  const auto first = bench.said().size();
  bench.ask(entry.sent);
  const std::string at_once = said_since(bench, first);
  if (!at_once.starts_with(entry.reply + "\n")) return fmt::format("the simulator answered '{}'", at_once);
  bench.rest();
  std::string expected = entry.reply + "\n";
  for (const auto& completion : entry.completions) expected += completion + "\n";
  const std::string all = said_since(bench, first);
  if (all != expected) return fmt::format("the simulator said '{}' until it came to rest", all);
  return {};
}

Complaint check(const Entry& entry) {
  if (auto complaint = check_by_table(entry)) return complaint;
  return check_by_simulator(entry);
}

}  // namespace axisgate::shrc203::conformance
