#include "server/rpc/support_report.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/common.h>
#include <grpcpp/grpcpp.h>
#include <prometheus/text_serializer.h>
#include <spdlog/version.h>

#include <boost/version.hpp>
#include <utility>

#include "server/config/text.h"
#include "server/machine.h"
#include "server/rpc/news.h"

namespace axisgate::rpc {
namespace {

using server::Redactor;

constexpr std::string_view kPreface =
    "== report of axisgated ==\n"
    "Replaced, each by the same stand-in throughout: serial numbers (such as 00000001), callers (user-1), hosts "
    "(host-1), paths (/path-1).\n"
    "Names of devices and axes, positions and everything else on the lines are as they are.\n";

std::string versions() {
  return fmt::format(
      "\n== versions ==\n"
      "axisgated {}\n"
      "compiler {}\n"
      "gRPC {}\nprotobuf {}\nspdlog {}.{}.{}\nfmt {}.{}.{}\nBoost {}\n"
      "system {}\n",
      AXISGATE_VERSION, __VERSION__, grpc::Version(),
      google::protobuf::internal::VersionString(GOOGLE_PROTOBUF_VERSION), SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR,
      SPDLOG_VER_PATCH, FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100, BOOST_LIB_VERSION,
      server::machine_text());
}

}  // namespace

SupportReport* SupportReport::start(server::Gateway& gateway, StreamLimit::Place place) {
  std::shared_ptr<SupportReport> report(new SupportReport(gateway, std::move(place)));
  report->open();
  report->pump();
  return report.get();
}

SupportReport::SupportReport(server::Gateway& gateway, StreamLimit::Place place) : place_(std::move(place)) {
  first_ = std::string(kPreface) + versions();
  first_ += "\n== configuration, with the defaults ==\n" + to_toml(redactor_.redact(gateway.config()));
  add_devices(gateway);
  first_ += "\n== metrics ==\n";
  first_ += prometheus::TextSerializer().Serialize(gateway.metrics().registry()->Collect());
  add_recordings(gateway);
}

void SupportReport::add_devices(server::Gateway& gateway) {
  for (const auto& device : gateway.devices()) {
    api::Device state = to_proto(*device, *device->newest_state().get().value);
    state.set_serial_number(redactor_.hide(Redactor::Kind::serial_number, state.serial_number()));
    state.set_link_problem(redactor_.redact(state.link_problem()));
    first_ += fmt::format("\n== state of {} ==\n{}", device->name(), state.DebugString());
  }
}

void SupportReport::add_recordings(server::Gateway& gateway) {
  for (const auto& device : gateway.devices()) {
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

SupportReport::Next SupportReport::next() {
  api::GetSupportReportResponse response;
  if (!first_.empty()) {
    response.set_text(std::exchange(first_, {}));
    return response;
  }
  while (!recordings_.empty()) {
    const std::string text = next_of(recordings_.front());
    if (!text.empty()) {
      response.set_text(redactor_.redact(text));
      return response;
    }
    recordings_.pop_front();
  }
  if (!std::exchange(summary_due_, false)) return grpc::Status::OK;
  response.set_text(fmt::format("\n== replaced ==\n{}\n", redactor_.summary()));
  return response;
}

}  // namespace axisgate::rpc
