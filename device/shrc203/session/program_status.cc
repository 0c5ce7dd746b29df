#include "device/shrc203/session/program_status.h"

namespace axisgate::shrc203 {

std::optional<ProgramStatus> program_status(const ExchangeResult& result) {
  const bool known = result.reply && !result.problem && result.reply->fields.size() > 2;
  if (!known) return std::nullopt;
  const auto& fields = result.reply->fields;
  return ProgramStatus{fields[0], fields[1], fields[2]};
}

}  // namespace axisgate::shrc203
