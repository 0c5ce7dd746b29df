#include "tests/echo/model.h"

#include <algorithm>

#include "tests/echo/machine.h"
#include "tests/echo/simulated_echo.h"
#include "tests/echo/text_check.h"

namespace axisgate::echo {

jobs::TimeRange PreparedText::takes() const {
  const Duration all = kLineTime * static_cast<int>(lines.size());
  return {all, 2 * all};
}

// The machine executes the line that it has, and no other.
jobs::RunOn PreparedText::run_on() const {
  std::size_t longest = 1;
  for (const Line& line : lines) longest = std::max(longest, line.text.size());
  return {longest, longest, 2 * kLineTime, 0};
}

Result<std::string> EchoModel::machine_named(std::string_view name) const {
  if (name == name_) return name_;
  return fail(Reason::invalid_request, "there is no such echo machine", "use " + name_);
}

Result<void> EchoModel::check_warning_name(std::string_view name) const {
  if (name == "open-line") return {};
  return fail(Reason::invalid_request, "there is no such warning", "the only warning is open-line");
}

std::unique_ptr<jobs::Check> EchoModel::make_check(const jobs::CheckOptions&) const {
  return std::make_unique<TextCheck>();
}

Result<std::shared_ptr<const jobs::PreparedJob>> EchoModel::prepare(const jobs::PartToPrepare& part) const {
  auto prepared = std::make_shared<PreparedText>();
  const std::uint64_t begin = part_begin(part.job);
  std::size_t at = part.job.setup.from ? part.job.setup.from->offset : 0;
  while (at < part.bytes.size()) {
    const std::size_t end = std::min(part.bytes.find('\n', at), part.bytes.size() - 1) + 1;
    std::string text(part.bytes.substr(at, end - at));
    if (!text.ends_with('\n')) text += '\n';
    prepared->lines.push_back({std::move(text), begin + end});
    at = end;
  }
  return prepared;
}

Result<jobs::Place> EchoModel::rest_from(const jobs::PartToPrepare& part, std::uint64_t line, std::uint64_t) const {
  const std::uint64_t offset = jobs::offset_of(part.bytes, line, 1);
  if (offset < part.bytes.size()) return jobs::place_of(part.bytes, offset);
  return fail(Reason::invalid_request, "the job has no such line", "name one of its lines");
}

Result<Duration> EchoModel::longest(const jobs::HandAct&, double) const {
  return fail(Reason::invalid_request, "an echo machine does nothing by hand", "send it a job");
}

std::unique_ptr<jobs::Machine> EchoModel::make_machine(const jobs::MachineSettings& settings, FlowLink& line,
                                                       jobs::MachineEvents& events, use::Permission& permission) const {
  return std::make_unique<EchoMachine>(settings, line, events, permission);
}

std::unique_ptr<Simulation> EchoModel::make_simulation(const Words&, std::size_t, double, ByteLink& line) const {
  return std::make_unique<SimulatedEcho>(line);
}

}  // namespace axisgate::echo
