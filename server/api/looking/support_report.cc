#include "server/api/looking/support_report.h"

#include <fmt/format.h>
#include <prometheus/text_serializer.h>
#include <spdlog/version.h>

#include <boost/version.hpp>
#include <string_view>
#include <utility>

#include "server/config/text.h"
#include "server/machine.h"

namespace axisgate::api {
namespace {

using server::Redactor;

constexpr std::string_view kPreface =
    "== report of axisgated ==\n"
    "Replaced, each by the same stand-in throughout: serial numbers (such as 00000001), callers (user-1), hosts "
    "(host-1), paths (/path-1).\n"
    "Names of devices and axes, positions and everything else on the lines are as they are.\n";

std::string versions(const DoorReport& door) {
  return fmt::format(
      "\n== versions ==\n"
      "axisgated {}\n"
      "compiler {}\n"
      "{}spdlog {}.{}.{}\nfmt {}.{}.{}\nBoost {}\n"
      "system {}\n",
      AXISGATE_VERSION, __VERSION__, door.versions, SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH,
      FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100, BOOST_LIB_VERSION, server::machine_text());
}

}  // namespace

SupportReport::SupportReport(server::Gateway& gateway, const DoorReport& door, Streams::Place place)
    : Subscription(std::move(place)) {
  first_ = std::string(kPreface) + versions(door);
  first_ += "\n== configuration, with the defaults ==\n" + to_toml(redactor_.redact(gateway.config()));
  add_devices(gateway, door);
  first_ += "\n== metrics ==\n";
  first_ += prometheus::TextSerializer().Serialize(gateway.metrics().registry()->Collect());
  add_recordings(gateway);
}

void SupportReport::add_devices(server::Gateway& gateway, const DoorReport& door) {
  for (const auto& device : gateway.stages()) {
    stage::State state = *device->newest_state().get().value;
    state.serial_number = redactor_.hide(Redactor::Kind::serial_number, state.serial_number);
    state.link_problem = redactor_.redact(state.link_problem);
    first_ += fmt::format("\n== state of {} ==\n{}", device->name(), door.describe(*device, state));
  }
}

void SupportReport::add_recordings(server::Gateway& gateway) {
  for (const auto& device : gateway.stages()) {
    server::DeviceRecorder& recorder = device->recorder();
    const server::RecordingRing::Beginning oldest = recorder.ring().oldest();
    recordings_.push_back({fmt::format("\n== recording of {} ==\n{}", device->name(), oldest.header),
                           server::DeviceRecorder::Reader(recorder, oldest.position), recorder.ring().newest()});
  }
}

std::string SupportReport::next_of(Recording& recording) {
  if (!recording.head.empty()) return std::exchange(recording.head, {});
  return recording.reader.position().line < recording.end.line ? recording.reader.next() : "";
}

SupportReport::Reading SupportReport::read() {
  if (!first_.empty()) return std::exchange(first_, {});
  while (!recordings_.empty()) {
    const std::string text = next_of(recordings_.front());
    if (!text.empty()) return redactor_.redact(text);
    recordings_.pop_front();
  }
  if (!std::exchange(summary_due_, false)) return StreamEnd{};
  return fmt::format("\n== replaced ==\n{}\n", redactor_.summary());
}

}  // namespace axisgate::api
