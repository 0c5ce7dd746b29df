#include "device/shrc203/session/front_panel.h"

#include <string>

#include "device/shrc203/session/answers.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

// Reads the mode and the format after a refused Q:, and disconnects if somebody has changed one of them at the front
// panel (hazard 19).
Task<void> FrontPanel::follow_mode() {
  if (non_host_.away()) co_return;
  const std::uint64_t connection = store_.connection();
  const auto mode = co_await dialogue_.ask(Dialogue::Question::mode, Lane::question, kGateway, true);
  if (!is_data(mode) || connection != store_.connection()) co_return;
  store_.note_mode(mode.reply->text);
  if (store_.state().mode == "HOST") {
    const auto format = co_await dialogue_.ask(Dialogue::Question::format, Lane::question, kGateway, true);
    if (!is_data(format) || connection != store_.connection()) co_return;
    store_.note_format(format.reply->text);
  }
  if (store_.state().mode == "HOST" && store_.state().format == "SHOT_FC") co_return;
  store_.note_wrong_panel();
  const LinkTrouble trouble = store_.trouble();
  line_.disconnect(std::string(store_.state().link_problem), tasks_.now());
  store_.note_trouble(trouble);
}

}  // namespace axisgate::shrc203
