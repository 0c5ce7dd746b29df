#include "server/api/looking/simulators.h"

#include <utility>

#include "server/api/request/names.h"

namespace axisgate::api {

// The simulator has its own strand, and answers there.
void Simulators::operate(const Call& call, std::string_view device, const std::string& command,
                         Answer<std::string> answer) const {
  const auto admitted = pipeline_.admit({RequestKind::operate_simulator, call, find_device(gateway_, device)});
  if (!admitted) return answer(tl::unexpected(admitted.error()));
  admitted->device->line().operate(command, std::move(answer));
}

}  // namespace axisgate::api
