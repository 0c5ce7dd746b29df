// Mills: what reads a whole job before it acts.
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "server/api/job_setup.h"
#include "server/api/mills.h"
#include "server/api/names.h"
#include "server/devices/spooled_jobs.h"

namespace axisgate::api {
namespace {

// As it was published last. What acts is compared with it on the strand.
Result<rml1::Job> published_job(server::Mill& mill, rml1::JobNumber number) {
  const auto now = mill.newest().get().value;
  const auto found = std::ranges::find(now->jobs, number, &rml1::Job::number);
  if (found != now->jobs.end()) return *found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number),
              "`axisctl mill queue` lists them");
}

}  // namespace

void Mills::start(const Call& call, std::string_view name, Answer<CurrentJob> answer) const {
  const Result<JobName> found = find_job_name(gateway_, name);
  const auto admitted = pipeline_.admit({RequestKind::start_job, call, device_of(found)});
  if (!admitted) return answer(tl::unexpected(admitted.error()));
  boost::asio::post(worker_, [this, call, name = std::string(name), &mill = *admitted->device, number = found->number,
                              answer = std::move(answer)] { start_on_worker(call, name, mill, number, answer); });
}

// Where it cannot be prepared it is refused for that, unless the request came before.
void Mills::start_on_worker(const Call& call, const std::string& name, server::Mill& mill, rml1::JobNumber number,
                            const Answer<CurrentJob>& answer) const {
  const auto prepared = published_job(mill, number).and_then([&mill](const rml1::Job& job) {
    return server::prepared_job(mill.spool(), mill.name(), mill.config(), job,
                                mill.newest().get().value->measured_pace);
  });
  act_on_job(
      RequestKind::start_job, call, name,
      [prepared](rml1::MillController& controller, const rml1::Job& it,
                 const TurnOf<server::Mill>& turn) -> Result<void> {
        if (!prepared) return tl::unexpected(prepared.error());
        const Result<void> fits = check_setup(turn.device, it);
        return fits ? controller.start(it.number, *prepared, turn.context, turn.now) : fits;
      },
      answer);
}

// In another state the job is refused for that.
void Mills::choose_rest(const Call& call, std::string_view name, LineToChoose from, Answer<CurrentJob> answer) const {
  const Result<JobName> found = find_job_name(gateway_, name);
  const auto admitted = pipeline_.admit({RequestKind::continue_job, call, device_of(found)});
  if (!admitted) return answer(tl::unexpected(admitted.error()));
  boost::asio::post(worker_, [this, call, name = std::string(name), from, &mill = *admitted->device,
                              number = found->number, answer = std::move(answer)] {
    const auto place = published_job(mill, number).and_then([&](const rml1::Job& job) {
      return server::chosen_rest(mill.spool(), mill.name(), mill.config(), job, from.line, from.column);
    });
    act_on_job(
        RequestKind::continue_job, call, name,
        [place](rml1::MillController& controller, const rml1::Job& it,
                const TurnOf<server::Mill>& turn) -> Result<void> {
          const bool can = rml1::next(it.state, rml1::JobEvent::choose_rest).has_value();
          if (can && !place) return tl::unexpected(place.error());
          return controller.choose_rest(it.number, place.value_or(rml1::Place()), turn.caller.who, turn.now);
        },
        answer);
  });
}

}  // namespace axisgate::api
