#include "tests/stress/plugged_unit.h"

#include <stdexcept>
#include <utility>

#include "device/shrc203/simulator/simulator.h"

namespace axisgate::stress {
namespace {

namespace simulator = shrc203::simulator;

template <class T>
T opened(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace

PluggedUnit::PluggedUnit(const std::string& path, simulator::Options options) {
  Pty pty = opened(open_pty(path));
  PtyWatch watch = opened(PtyWatch::open(pty));
  line_ = std::make_shared<PtyLine>(boost::asio::make_strand(context_), std::move(pty), std::move(watch));
  device_ =
      std::make_unique<PacedLine>(Pacing{0, {}, 100}, *line_, [&](ByteLink& inside) -> std::unique_ptr<LineMachine> {
        return std::make_unique<simulator::Simulator>(std::move(options), inside);
      });
  line_->attach(*device_);
  line_->start();
  thread_ = std::thread([this] { context_.run(); });
}

PluggedUnit::~PluggedUnit() {
  boost::asio::post(line_->strand(), [line = line_] { line->shutdown(); });
  thread_.join();
}

}  // namespace axisgate::stress
