// Requests of the line's parts to the line as a whole.
#pragma once

#include <string>

#include "device/core/time.h"
#include "device/shot/line/link.h"

namespace axisgate::shot {

class Port {
 public:
  virtual ~Port() = default;
  // Applies the event to the link. Returns false and closes the port if the phase does not permit the event.
  virtual bool change(LinkEvent event, TimePoint now) = 0;
  // Closes the port; it is opened again after the backoff. `event` is `lost` or `flooded`. No part of the line may use
  // the exchange after this.
  virtual void close(LinkEvent event, const std::string& why, TimePoint now) = 0;
};

}  // namespace axisgate::shot
