// Parsing of typed paths: straight lines and arcs, in a file or after `line` and `arc`.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/stage.pb.h"

namespace axisgate::axisctl {

// All functions throw Failure if the text is not valid.

struct PathOptions {
  std::string speed;  // for segments without speed=; empty: speeds of the axes
  int acceleration_ms = 0;
  bool absolute = false;
};

// Parses one segment, with speed=, rest= and inputs= among its words:
//   1=1mm 2=-500um speed=2mm/s
//   around 1=0 2=1mm ccw 90deg              cw or ccw; 90deg, 1turn, 2turns
//   around 1=0 2=1mm cw 2turns rise 3=0.1mm
//   through 1=1mm 2=1mm to 1=2mm 2=0        with or without a rise
v1::Segment parse_segment(const v1::Device& device, const PathOptions& options, const std::vector<std::string>& words);

// Parses a file with one segment a line. # begins a comment; empty lines are skipped.
std::vector<v1::Segment> parse_path(const v1::Device& device, const PathOptions& options, std::istream& input,
                                    const std::string& file_name);

}  // namespace axisgate::axisctl
