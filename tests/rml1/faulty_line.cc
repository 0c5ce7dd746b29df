#include "tests/rml1/faulty_line.h"

#include <utility>

namespace axisgate::rml1 {
namespace {

constexpr char kXonByte = 0x11;

}  // namespace

FaultyLine::FaultyLine(simulator::MillBench& mill, Setup setup, simulator::Flow flow, bool loses_xon,
                       std::function<void(std::string_view)> writes)
    : LineToMill(mill, setup), flow_(flow), loses_xon_(loses_xon), writes_(std::move(writes)) {}

void FaultyLine::write(std::string_view bytes) {
  writes_(bytes);
  LineToMill::write(bytes);
}

// Forgets an earlier XOFF, as a driver does that obeys XON and XOFF again (device/link/runner.cc).
void FaultyLine::ignore_flow_control(bool ignored) {
  if (ignored) xoff_ = false;
  LineToMill::ignore_flow_control(ignored);
}

void FaultyLine::take_flow_control() {
  for (; taken_ < mill_.written.size(); ++taken_) {
    if (mill_.written[taken_] != kXonByte) {
      xoff_ = true;
    } else if (loses_xon_ && !xon_lost_) {
      xon_lost_ = true;
    } else {
      xoff_ = false;
    }
  }
}

bool FaultyLine::stopped() const {
  if (flow_ == simulator::Flow::rts) return stuck || mill_.mill.holds_back();
  return xoff_;
}

}  // namespace axisgate::rml1
