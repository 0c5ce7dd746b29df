// Mills: what the owner of a job, or an administrator, does with it while it waits.
#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "server/access/access.h"
#include "server/api/mills.h"

namespace axisgate::api {
namespace {

bool is_admin(const TurnOf<server::Mill>& turn) { return turn.caller.role == server::Role::admin; }

// `act`: "cancel".
Result<void> check_owner(const TurnOf<server::Mill>& turn, const rml1::Job& job, std::string_view act) {
  if (is_admin(turn) || server::is_certainly(turn.caller.who, job.owner)) return {};
  return fail(Reason::not_allowed, fmt::format("{} is not yours", text_of(job)),
              fmt::format("its owner or an administrator can {} it", act));
}

}  // namespace

void Mills::cancel(const Call& call, std::string_view job, Answer<CurrentJob> answer) const {
  act_on_job(
      RequestKind::cancel_job, call, job,
      [](rml1::MillController& mill, const rml1::Job& it, const TurnOf<server::Mill>& turn) -> Result<void> {
        const Result<void> may = check_owner(turn, it, "cancel");
        return may ? mill.cancel(it.number, turn.caller.who, turn.now) : may;
      },
      std::move(answer));
}

void Mills::move_first(const Call& call, std::string_view job, Answer<CurrentJob> answer) const {
  act_on_job(
      RequestKind::move_job, call, job,
      [](rml1::MillController& mill, const rml1::Job& it, const TurnOf<server::Mill>& turn) -> Result<void> {
        const Result<void> may = check_owner(turn, it, "move");
        if (!may) return may;
        return mill.move_first(it.number, is_admin(turn) ? rml1::Overtaken::all : rml1::Overtaken::of_its_owner,
                               turn.caller.who, turn.now);
      },
      std::move(answer));
}

}  // namespace axisgate::api
