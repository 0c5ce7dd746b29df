// What people type as paths: straight lines and arcs, in a file or behind `line` and `arc`.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/stage.pb.h"

namespace axisgate::axisctl {

// Everything here throws Failure for what it cannot read.

struct PathOptions {
  std::string speed;  // for the segments that name none; empty: as the axes are set
  int acceleration_ms = 0;
  bool absolute = false;
};

// One segment, with speed=, rest= and inputs= among its words:
//   1=1mm 2=-500um speed=2mm/s
//   around 1=0 2=1mm ccw 90deg              cw or ccw; 90deg, 1turn, 2turns
//   around 1=0 2=1mm cw 2turns rise 3=0.1mm
//   through 1=1mm 2=1mm to 1=2mm 2=0        with or without a rise
v1::Segment parse_segment(const v1::Device& device, const PathOptions& options, const std::vector<std::string>& words);

// One segment a line; # begins a comment, and nothing but a comment is no segment.
std::vector<v1::Segment> parse_path(const v1::Device& device, const PathOptions& options, std::istream& input,
                                    const std::string& file_name);

}  // namespace axisgate::axisctl
