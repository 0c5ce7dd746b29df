#include "server/rpc/setting_service.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/rpc/call.h"
#include "server/rpc/gatekeeper.h"
#include "server/rpc/settings.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

using stage::ExecuteEvent;
using stage::StageController;

// What cannot be told while something moves is not waited for: what is known of it stands.
constexpr Duration kAnswerLimit = std::chrono::seconds(2);

bool untold(const Problem& problem) {
  return problem.reason == Reason::completion_outstanding || problem.reason == Reason::deadline_passed;
}

Problem not_answered(std::string_view question, const std::string& reply) {
  return {.reason = Reason::device_refused,
          .message = fmt::format("the controller refused {} ({})", question, reply),
          .hint = "look at its mode: axisctl status",
          .sent = std::string(question),
          .wire_reply = reply};
}

// The answers, as they come; told when the last has.
struct Asking {
  UnaryCall<api::GetSettingsResponse>::Handle call;
  const stage::Kind& kind;
  stage::Settings settings;
  std::size_t open = 0, answered = 0;
  std::optional<Problem> problem, last_untold;
};

void take(const std::shared_ptr<Asking>& asking, std::string_view question, const ExecuteEvent& event,
          const stage::State& state) {
  const bool refused = event.wire_reply.starts_with("NG");
  if (event.kind == ExecuteEvent::Kind::reply && refused) asking->problem = not_answered(question, event.wire_reply);
  if (event.kind == ExecuteEvent::Kind::reply && !refused) {
    ++asking->answered;
    asking->kind.read_setting(question, event.answer, state, asking->settings);
  }
  if (event.kind != ExecuteEvent::Kind::ended) return;
  if (event.problem && untold(*event.problem)) asking->last_untold = event.problem;
  if (event.problem && !untold(*event.problem) && !asking->problem) asking->problem = event.problem;
  if (--asking->open > 0) return;
  if (asking->answered == 0 && !asking->problem) asking->problem = asking->last_untold;
  if (asking->problem) {
    asking->call->refuse(*asking->problem);
  } else {
    asking->call->answer(
        [&](api::GetSettingsResponse& answer) { *answer.mutable_settings() = to_proto(asking->settings); });
  }
}

Result<void> check_role(const Lines& lines, const server::Caller& caller, const server::Access& access) {
  if (caller.role == server::Role::admin) return {};
  for (const std::string& line : lines) {
    if (const auto allowed = check_command_role(line, caller, access); !allowed) return allowed;
  }
  return {};
}

}  // namespace

grpc::ServerUnaryReactor* SettingService::GetSettings(grpc::CallbackServerContext* context,
                                                      const api::GetSettingsRequest* request,
                                                      api::GetSettingsResponse* response) {
  const auto call = UnaryCall<api::GetSettingsResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  (*device)->post([call, asked = question_context(*context), &kind = (*device)->kind()](StageController& controller,
                                                                                        TimePoint now) {
    const stage::LinkState link = controller.state().link;
    if (link != stage::LinkState::up && link != stage::LinkState::doubtful) {
      call->refuse({.reason = Reason::link_down,
                    .message = "the device is not up: " + controller.state().link_problem,
                    .hint = "try again when it is up"});
      return;
    }
    const auto questions = kind.setting_questions();
    const std::shared_ptr<Asking> asking(
        new Asking{call, kind, known_settings(controller.state()), questions.size(), 0, {}, {}});
    if (questions.empty()) {
      return call->answer(
          [&](api::GetSettingsResponse& answer) { *answer.mutable_settings() = to_proto(asking->settings); });
    }
    auto limited = asked;
    limited.not_after = std::min(limited.not_after, now + kAnswerLimit);
    for (const std::string_view question : questions) {
      controller.execute({{std::string(question)}, limited}, now,
                         [asking, question, &controller](const ExecuteEvent& event) {
                           take(asking, question, event, controller.state());
                         });
    }
  });
  return call.get();
}

// As one transaction of the lines that the request comes to.
template <class Request, class Response, class ToLines>
grpc::ServerUnaryReactor* SettingService::change(const grpc::CallbackServerContext& context, const Request& request,
                                                 Response* response, ToLines to_lines) {
  const auto call = UnaryCall<Response>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request.device());
  if (!device) return call->refuse(device.error());
  Result<stage::RequestContext> asked = mutation_context(context, request.context());
  if (!asked) return call->refuse(asked.error());
  const Result<server::Caller> caller = caller_with_role(context, access_);
  if (!caller) return call->refuse(caller.error());
  if (const auto role = role_of(context, access_); role) asked->role = *role;
  (*device)->post([call, request, to_lines, asked = *asked, caller = *caller, &access = access_,
                   &kind = (*device)->kind()](StageController& controller, TimePoint now) {
    const Result<Lines> lines = to_lines(request, kind, controller.state());
    if (!lines) return static_cast<void>(call->refuse(lines.error()));
    if (const auto allowed = check_role(*lines, caller, access); !allowed) {
      return static_cast<void>(call->refuse(allowed.error()));
    }
    const stage::ExecuteRequest transaction{*lines, asked};
    if (request.validate_only()) {
      const Result<void> checked = kind.check_lines(transaction.lines);
      if (!checked) return static_cast<void>(call->refuse(checked.error()));
      return call->answer([](Response&) {});
    }
    controller.execute(transaction, now, [call](const ExecuteEvent& event) {
      if (event.kind != ExecuteEvent::Kind::ended) return;
      event.problem ? static_cast<void>(call->refuse(*event.problem)) : call->answer([](Response&) {});
    });
  });
  return call.get();
}

grpc::ServerUnaryReactor* SettingService::ChangeSettings(grpc::CallbackServerContext* context,
                                                         const api::ChangeSettingsRequest* request,
                                                         api::ChangeSettingsResponse* response) {
  return change(*context, *request, response,
                [](const api::ChangeSettingsRequest& asked, const stage::Kind& kind, const stage::State& state) {
                  return lines_of(asked, kind, state);
                });
}

grpc::ServerUnaryReactor* SettingService::SetCoordinates(grpc::CallbackServerContext* context,
                                                         const api::SetCoordinatesRequest* request,
                                                         api::SetCoordinatesResponse* response) {
  return change(*context, *request, response,
                [](const api::SetCoordinatesRequest& asked, const stage::Kind& kind, const stage::State& state) {
                  return lines_of(asked, kind, state);
                });
}

grpc::ServerUnaryReactor* SettingService::FireTrigger(grpc::CallbackServerContext* context,
                                                      const api::FireTriggerRequest* request,
                                                      api::FireTriggerResponse* response) {
  return change(*context, *request, response, [](const auto&, const stage::Kind& kind, const stage::State& state) {
    return kind.lines_for(stage::FireTrigger{}, state);
  });
}

grpc::ServerUnaryReactor* SettingService::ResetDevice(grpc::CallbackServerContext* context,
                                                      const api::ResetDeviceRequest* request,
                                                      api::ResetDeviceResponse* response) {
  return change(*context, *request, response, [](const auto&, const stage::Kind& kind, const stage::State& state) {
    return kind.lines_for(stage::ResetController{}, state);
  });
}

}  // namespace axisgate::rpc
