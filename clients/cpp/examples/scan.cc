// Runs a scan, shows its progress, and compares the trigger pulses.
#include <axisgate/axisgate.h>

#include <iostream>

using namespace axisgate::literals;

int main() {
  try {
    axisgate::Stage stage;
    stage.home_if_needed({"x"});
    const axisgate::Motion scan =
        stage.scan({.axis = "x", .start = 0_mm, .end = 1_mm, .every = 10_um, .speed = (500_um).per_second()});
    scan.follow([](const axisgate::Progress& progress) { std::cout << progress.positions.front() << '\n'; });
    const axisgate::ScanResult pulses = *scan.wait().scan;
    std::cout << pulses.expected_in_range.value_or(0) << " trigger pulses in the range\n";
    return pulses.observed == pulses.expected ? 0 : 1;
  } catch (const axisgate::Error& error) {
    std::cout << error.what() << '\n';
    return 1;
  }
}
