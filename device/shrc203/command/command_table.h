// The only table of the controller's commands.
#pragma once

#include "device/shot/command/model.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// The SHRC-203 as a model of its family: its axes, commands and notices.
const Model& model();

}  // namespace axisgate::shrc203
