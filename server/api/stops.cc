#include "server/api/stops.h"

#include <utility>

#include "server/api/names.h"

namespace axisgate::api {
namespace {

using stage::StageController;
using stage::StopReport;

StageController::OnStopped answering(Answer<StopReport> answer) {
  return [answer = std::move(answer)](StopReport report) { answer(std::move(report)); };
}

}  // namespace

void Stops::stop(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                 Answer<StopReport> answer) const {
  const Result<server::Stage*> found = find_stage(gateway_, device);
  if (!found) return answer(tl::unexpected(found.error()));
  if (!axes) return answer(tl::unexpected(axes.error()));
  (*found)->post(
      [axes = *axes, context = admission_.context_of_stop(call), answer = std::move(answer)](
          StageController& controller, TimePoint now) { controller.stop(axes, context, now, answering(answer)); });
}

void Stops::emergency_stop(const Call& call, std::string_view device, Answer<StopReport> answer) const {
  const Result<server::Stage*> found = find_stage(gateway_, device);
  if (!found) return answer(tl::unexpected(found.error()));
  (*found)->post(
      [context = admission_.context_of_stop(call), answer = std::move(answer)](
          StageController& controller, TimePoint now) { controller.emergency_stop(context, now, answering(answer)); });
}

}  // namespace axisgate::api
