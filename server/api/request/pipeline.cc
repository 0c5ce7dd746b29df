#include "server/api/request/pipeline.h"

namespace axisgate::api {

Result<void> check_deadline(RequestKind kind, const use::RequestContext& context, TimePoint now) {
  if (rule_of(kind).deadline != DeadlineRule::motion || now <= context.not_after) return {};
  return fail(Reason::deadline_passed, "the request reached the device after its not_after",
              "ask again, with a later not_after");
}

}  // namespace axisgate::api
