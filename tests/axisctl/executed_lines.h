// Range of places at which the executed part of a job ends: the beginnings of two lines.
#pragma once

#include "axisgate/v1/mill.pb.h"

namespace axisgate::axisctl {

inline v1::JobPlaceRange executed_lines(int least, int most) {
  v1::JobPlaceRange range;
  range.mutable_least()->set_line(least);
  range.mutable_least()->set_column(1);
  range.mutable_most()->set_line(most);
  range.mutable_most()->set_column(1);
  return range;
}

}  // namespace axisgate::axisctl
