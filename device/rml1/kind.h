// The kind of device "rml1": a mill that reads RML-1, its check, its controller and its simulation.
#pragma once

#include "device/jobs/kind.h"

namespace axisgate::rml1 {

const jobs::Kind& kind();

}  // namespace axisgate::rml1
