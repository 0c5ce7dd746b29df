// axisgated-contrast: the daemon, except that a path's refills wait their turn among all questions. The program shows
// why refills need priority, and has no other use.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <string_view>

#include "device/shrc203/controller.h"
#include "device/shrc203/kind.h"
#include "server/access/access.h"
#include "server/config/config.h"
#include "server/connections/callers.h"
#include "server/connections/descriptor_limit.h"
#include "server/devices/saved_positions.h"
#include "server/doors/doors.h"
#include "server/end_signals.h"
#include "server/gateway.h"
#include "server/log.h"

namespace axisgate {
namespace {

// An SHRC-203 whose refills wait among questions.
class Contrast final : public stage::Kind {
 public:
  std::string_view name() const override { return "shrc203"; }
  int axis_count() const override { return shrc203::kind().axis_count(); }
  std::span<const stage::KindSetting> settings() const override { return shrc203::kind().settings(); }
  std::span<const stage::Capability> capabilities() const override { return shrc203::kind().capabilities(); }
  std::unique_ptr<stage::StageController> make_controller(const stage::Profile& profile, const Words&, ByteLink& link,
                                                          stage::EventSink& events,
                                                          use::Permission& permission) const override {
    shrc203::Profile own(profile);
    own.refills = shrc203::Refills::among_questions;
    return std::make_unique<shrc203::Controller>(std::move(own), link, events, permission);
  }
  Result<void> check_lines(const std::vector<std::string>& lines) const override {
    return shrc203::kind().check_lines(lines);
  }
  std::vector<stage::CommandInfo> commands() const override { return shrc203::kind().commands(); }
  Result<std::vector<std::string>> lines_for(const stage::Setting& setting, const stage::State& state) const override {
    return shrc203::kind().lines_for(setting, state);
  }
  std::span<const std::string_view> setting_questions() const override { return shrc203::kind().setting_questions(); }
  void read_setting(std::string_view question, std::string_view answer, const stage::State& state,
                    stage::Settings& settings) const override {
    shrc203::kind().read_setting(question, answer, state, settings);
  }
  std::optional<stage::PositionLines> position_lines(const stage::PositionSlot& slot) const override {
    return shrc203::kind().position_lines(slot);
  }
  std::map<int, std::int64_t> read_position(const stage::PositionSlot& slot, std::string_view answer,
                                            const stage::State& state) const override {
    return shrc203::kind().read_position(slot, answer, state);
  }
  Result<void> check_option(std::string_view name, std::string_view value) const override {
    return shrc203::kind().check_option(name, value);
  }
  std::unique_ptr<Simulation> make_simulation(const Words& options, ByteLink& line) const override {
    return shrc203::kind().make_simulation(options, line);
  }
};

int serve(const char* config_path) {
  static const Contrast contrast;
  static const std::array<const stage::Kind*, 1> kinds = {&contrast};
  auto config = server::load_config(config_path, {.stages = kinds});
  if (!config) {
    for (const auto& error : config.error()) fmt::print(stderr, "{}\n", to_string(error));
    return 2;
  }
  server::EndSignals end_signals;
  server::log::start();
  const auto positions = *server::SavedPositions::open("");
  server::Access access({}, server::caller_name(::geteuid()), *server::Tokens::open(""));
  server::Gateway gateway(*config, 1);
  const auto server = server::Doors::open(gateway, access, *positions, {server::raise_descriptor_limit()});
  if (!server) {
    fmt::print(stderr, "axisgated-contrast: {}\n", server.error().message);
    return 1;
  }
  gateway.start();
  end_signals.wait(gateway);
  return 0;
}

}  // namespace
}  // namespace axisgate

int main(int count, char** words) {
  if (count == 3 && std::string_view(words[1]) == "--config") return axisgate::serve(words[2]);
  fmt::print(stderr, "usage: axisgated-contrast --config FILE\n");
  return 2;
}
