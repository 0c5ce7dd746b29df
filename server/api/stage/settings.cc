#include "server/api/stage/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "server/api/request/names.h"
#include "server/api/request/request_texts.h"
#include "server/limits.h"

namespace axisgate::api {
namespace {

using stage::ExecuteEvent;

bool is_unread(const Problem& problem) {
  return problem.reason == Reason::completion_outstanding || problem.reason == Reason::deadline_passed;
}

Problem not_answered(std::string_view question, const std::string& reply) {
  return {.reason = Reason::device_refused,
          .message = fmt::format("the controller refused {} ({})", question, reply),
          .hint = "check its mode: `GetDevice`",
          .sent = std::string(question),
          .wire_reply = reply};
}

// An Asking collects the answers, and delivers the settings after the last one.
class Asking {
 public:
  Asking(const stage::Kind& kind, const stage::State& state, std::size_t questions, Answer<stage::Settings> answer)
      : kind_(kind),
        answer_(std::move(answer)),
        settings_{.outputs = state.outputs, .trigger = state.trigger},
        open_(questions) {}

  void take(std::string_view question, const ExecuteEvent& event, const stage::State& state) {
    if (event.kind == ExecuteEvent::Kind::reply) return take_reply(question, event, state);
    if (event.kind != ExecuteEvent::Kind::ended) return;
    if (event.problem && is_unread(*event.problem)) {
      last_unread_ = event.problem;
    } else if (!problem_) {
      problem_ = event.problem;
    }
    if (--open_ == 0) finish();
  }

  void finish() {
    if (answered_ == 0 && !problem_) problem_ = last_unread_;
    if (problem_) return answer_(tl::unexpected(*problem_));
    answer_(std::move(settings_));
  }

 private:
  void take_reply(std::string_view question, const ExecuteEvent& event, const stage::State& state) {
    if (event.wire_reply.starts_with("NG")) {
      problem_ = not_answered(question, event.wire_reply);
      return;
    }
    ++answered_;
    kind_.read_setting(question, event.answer, state, settings_);
  }

  const stage::Kind& kind_;
  const Answer<stage::Settings> answer_;
  stage::Settings settings_;
  std::size_t open_, answered_ = 0;
  std::optional<Problem> problem_, last_unread_;
};

void ask_all(const Turn& turn, const std::shared_ptr<Asking>& asking) {
  use::RequestContext limited = turn.context;
  limited.not_after = std::min(limited.not_after, turn.now + server::kSettingAnswerLimit);
  for (const std::string_view question : turn.device.kind().setting_questions()) {
    turn.controller.execute({{std::string(question)}, limited}, turn.now,
                            [asking, question, &controller = turn.controller](const ExecuteEvent& event) {
                              asking->take(question, event, controller.state());
                            });
  }
}

}  // namespace

void Settings::get(const Call& call, std::string_view device, Answer<stage::Settings> answer) const {
  pipeline_.ask({RequestKind::get_settings, call, find_stage(gateway_, device)}, std::move(answer),
                [](const Turn& turn, const Answer<stage::Settings>& respond) {
                  if (const auto up = turn.controller.check_up(); !up) {
                    return respond(tl::unexpected(up.error()));
                  }
                  const stage::Kind& kind = turn.device.kind();
                  const auto asking =
                      std::make_shared<Asking>(kind, turn.controller.state(), kind.setting_questions().size(), respond);
                  kind.setting_questions().empty() ? asking->finish() : ask_all(turn, asking);
                });
}

// Runs the lines of the request as one transaction. Lines that are kept for administrators are refused before any is
// sent.
template <class ToLines>
void Settings::set(const Asked& asked, std::string_view verb, Answer<void> answer, ToLines to_lines) const {
  pipeline_.run(
      asked, std::move(answer),
      [&access = access_, to_lines = std::move(to_lines)](const Turn& turn) -> Result<Lines> {
        Result<Lines> lines = to_lines(turn.device.kind(), turn.controller.state());
        if (!lines) return lines;
        for (const std::string& line : *lines) {
          if (const auto allowed = check_line(access, line, turn.caller); !allowed) {
            return tl::unexpected(allowed.error());
          }
        }
        return lines;
      },
      [](const Turn& turn, const Lines& lines) { return turn.device.kind().check_lines(lines); },
      [verb](const Lines& lines) { return text_of(verb, lines); },
      [](const Turn& turn, Lines lines, const Answer<void>& respond) {
        turn.controller.execute({std::move(lines), turn.context}, turn.now, [respond](const ExecuteEvent& event) {
          if (event.kind != ExecuteEvent::Kind::ended) return;
          respond(event.problem ? tl::unexpected(*event.problem) : Result<void>());
        });
      });
}

void Settings::change(const Call& call, std::string_view device, const Result<SettingsChange>& change,
                      Answer<void> answer) const {
  set({RequestKind::change_settings, call, find_stage(gateway_, device), fault_of(change)}, "change settings",
      std::move(answer),
      [change](const stage::Kind& kind, const stage::State& state) { return lines_of(*change, kind, state); });
}

void Settings::set_coordinates(const Call& call, std::string_view device, const Result<NewCoordinates>& coordinates,
                               Answer<void> answer) const {
  set({RequestKind::set_coordinates, call, find_stage(gateway_, device), fault_of(coordinates)}, "set coordinates",
      std::move(answer), [coordinates](const stage::Kind& kind, const stage::State& state) {
        return lines_of(*coordinates, kind, state);
      });
}

void Settings::fire_trigger(const Call& call, std::string_view device, Answer<void> answer) const {
  set({RequestKind::fire_trigger, call, find_stage(gateway_, device)}, "fire the trigger", std::move(answer),
      [](const stage::Kind& kind, const stage::State& state) { return kind.lines_for(stage::FireTrigger{}, state); });
}

void Settings::reset(const Call& call, std::string_view device, Answer<void> answer) const {
  set({RequestKind::reset_device, call, find_stage(gateway_, device)}, "reset the device", std::move(answer),
      [](const stage::Kind& kind, const stage::State& state) {
        return kind.lines_for(stage::ResetController{}, state);
      });
}

}  // namespace axisgate::api
