// Extent of a job that cuts out 38 x 30 x 1.7 mm.
#pragma once

#include "axisgate/v1/mill.pb.h"

namespace axisgate::axisctl {

inline v1::JobExtent cut_out() {
  v1::JobExtent extent;
  const auto set = [](v1::AxisExtent& axis, double least, double most) {
    axis.set_least_mm(least);
    axis.set_most_mm(most);
  };
  set(*extent.mutable_x(), -1, 38);
  set(*extent.mutable_y(), 0, 30);
  set(*extent.mutable_z(), -1.7, 2);
  set(*extent.mutable_cut_x(), 0, 38);
  set(*extent.mutable_cut_y(), 0, 30);
  extent.set_deepest_mm(1.7);
  return extent;
}

}  // namespace axisgate::axisctl
