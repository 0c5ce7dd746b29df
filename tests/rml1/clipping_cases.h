// The geometries of clipping/cases.txt and the machine's moves for them.
#pragma once

#include <string>
#include <vector>

#include "tests/rml1/mill.h"
#include "tests/rml1/paragraphs.h"

namespace axisgate::rml1 {

struct ClippingCase {
  std::string job;
  Played whole;
  std::size_t begin = 0;               // index of the first move that is judged
  std::vector<jobs::Point> commanded;  // from the place where that move begins
};

ClippingCase play_case(const Paragraph& geometry);

}  // namespace axisgate::rml1
