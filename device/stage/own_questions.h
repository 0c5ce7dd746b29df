// The caller name of the gateway's own questions.
#pragma once

#include <string>

namespace axisgate::stage {

// Name in events and recordings for questions that the gateway asks for itself; no caller has this name.
inline const std::string kGateway = "gateway";

}  // namespace axisgate::stage
