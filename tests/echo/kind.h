// The kind of device "echo": a second machine that is sent jobs, for tests only. Its jobs are lines of text. It answers
// each line with the same line when it has executed it, which no mill does.
#pragma once

#include "device/jobs/kind.h"

namespace axisgate::echo {

const jobs::Kind& kind();

}  // namespace axisgate::echo
