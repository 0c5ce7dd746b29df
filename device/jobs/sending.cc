#include "device/jobs/sending.h"

#include <array>

namespace axisgate::jobs {
namespace {

constexpr std::array<std::string_view, kSenderStates> kSenderStateNames = {
    "READY", "SENDING", "PAUSED", "FINISHING", "FED", "ABORTING", "ABORTED", "LOST", "RAISING", "RAISED"};

}  // namespace

std::string_view name(SenderState state) { return kSenderStateNames.at(static_cast<std::size_t>(state)); }

bool is_end(SenderState state) {
  return state == SenderState::fed || state == SenderState::aborted || state == SenderState::lost ||
         state == SenderState::raised;
}

}  // namespace axisgate::jobs
