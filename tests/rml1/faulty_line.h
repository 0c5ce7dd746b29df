// Line to the simulated mill on which CTS can be stuck and an XON lost.
#pragma once

#include <functional>
#include <string_view>

#include "tests/rml1/abort_bench.h"

namespace axisgate::rml1 {

class FaultyLine : public LineToMill {
 public:
  // `loses_xon` loses the first XON. `writes` is called with the bytes before they are written.
  FaultyLine(simulator::MillBench& mill, Setup setup, simulator::Flow flow, bool loses_xon,
             std::function<void(std::string_view)> writes);

  void write(std::string_view bytes) override;
  void ignore_flow_control(bool ignored) override;

  void take_flow_control();  // takes the flow control that the mill has sent
  bool has_lost_xon() const { return xon_lost_; }

  bool stuck = false;  // CTS is low, whatever the mill does

 private:
  bool stopped() const override;

  const simulator::Flow flow_;
  const bool loses_xon_;
  const std::function<void(std::string_view)> writes_;
  std::size_t taken_ = 0;  // bytes taken of those that the mill has sent
  bool xoff_ = false, xon_lost_ = false;
};

}  // namespace axisgate::rml1
