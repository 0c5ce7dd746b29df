// Who asks where no caller does.
#pragma once

#include <string>

namespace axisgate::stage {

// The name in events and recordings of what the gateway asks for itself: no person's.
inline const std::string kGateway = "gateway";

}  // namespace axisgate::stage
