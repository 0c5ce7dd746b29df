// The line between the gateway and the simulated controller, in virtual time, with faults. Every line of the device
// carries the number of the command that it answers, which the gateway does not see and the checks do.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "tests/simulation/random.h"

namespace axisgate::simulation {

// Probabilities a line, and for what befalls device and link an hour. Zero everywhere: a perfect line.
struct Faults {
  double drop_command = 0;     // line: a command never arrives
  double flip_command = 0;     // line: one bit of a command is wrong
  double null_in_command = 0;  // line: a NUL in a command (NG_I)
  double drop_reply = 0;
  double late_reply = 0;
  double double_reply = 0;
  double false_ng = 0;
  double flip_reply = 0;
  double noise = 0;  // line: a burst of bytes between lines
  double split = 0;  // line: a pause in the middle of a line
  double drop_notice = 0;
  double late_notice = 0;
  double double_notice = 0;
  double flood_notice = 0;     // notice: one number many times
  double mishaps_an_hour = 0;  // device and link: mishaps.h

  static Faults none() { return {}; }
  static Faults mild();
  static Faults rough();
  static Faults hostile();
  // "quiet", "mild", "rough", "hostile"; nothing for another name.
  static std::optional<Faults> named(std::string_view profile);
};

// What was going on when a fault struck.
enum class Phase { idle, set, acknowledged, started, moving, completing, barrier, path };
inline constexpr std::array<std::string_view, 8> kPhaseNames = {"idle",   "set",        "acknowledged", "started",
                                                                "moving", "completing", "barrier",      "path"};
inline std::string_view name(Phase phase) { return kPhaseNames[static_cast<std::size_t>(phase)]; }

struct Origin {
  enum class Kind { reply, notice, noise } kind = Kind::reply;
  std::size_t command = 0;  // a reply's: the index of the command line that it answers
};

// A fault at one place instead of at random: what is done to one line.
struct Scripted {
  bool drop = false;
  Duration delay{};                    // of this line and those behind it; a notice waits alone
  std::optional<std::string> instead;  // these bytes, terminator and all
};
enum class LineKind { command, reply, notice };
using Script = std::function<Scripted(LineKind, const std::string& line)>;

class Wire {
 public:
  Wire(Random& random, int baud) : random_(random), byte_time_(std::chrono::nanoseconds(10'000'000'000 / baud)) {}

  void set_faults(const Faults& faults) { faults_ = faults; }
  // Asked for every line, before the faults are drawn.
  void set_script(Script script) { script_ = std::move(script); }

  // The gateway's end and the device's end.
  ByteLink& gateway_end() { return gateway_end_; }
  ByteLink& device_end() { return device_end_; }
  void connect(LineMachine& gateway, LineMachine& device) {
    gateway_ = &gateway;
    device_ = &device;
  }

  void open(TimePoint now);
  std::optional<TimePoint> next_event() const;
  void advance(TimePoint now);
  void cut(TimePoint now, Duration until_back);  // unplugged

  // What the gateway wrote, oldest first, and what a delivered line was while it is being delivered.
  const std::vector<std::string>& commands() const { return commands_; }
  bool answered() const { return unanswered_.empty(); }  // by the device; the reply may be under way
  // Whether what the device writes now answers a command, and whether it reads at all (it does not while it restarts).
  void set_device(std::function<bool()> answers, std::function<bool()> reads) {
    device_answers_ = std::move(answers);
    device_reads_ = std::move(reads);
  }
  void device_restarts() { unanswered_.clear(); }
  const std::optional<Origin>& delivering() const { return delivering_; }
  const std::deque<std::string>& log() const { return log_; }
  void note(TimePoint now, const std::string& text);

  // Faults count from 0 in the order in which they would strike; those named here do not.
  void spare(std::set<std::uint64_t> faults) { spared_ = std::move(faults); }
  void set_phase(std::function<Phase()> phase) { phase_ = std::move(phase); }
  // For a fault that another injects: counted, noted, or spared.
  bool inject(const char* kind);
  std::uint64_t faults_drawn() const { return drawn_; }
  bool happened(const std::string& kind) const { return by_kind_.contains(kind); }
  using ByPhase = std::array<std::uint64_t, kPhaseNames.size()>;
  const std::map<std::string, ByPhase>& faults_by_kind() const { return by_kind_; }

 private:
  struct GatewayEnd : ByteLink {
    explicit GatewayEnd(Wire& owner) : wire(owner) {}
    void write(std::string_view bytes) override { wire.from_gateway(bytes); }
    void reopen(Duration wait) override { wire.reopen(wait); }
    Wire& wire;
  };
  struct DeviceEnd : ByteLink {
    explicit DeviceEnd(Wire& owner) : wire(owner) {}
    void write(std::string_view bytes) override { wire.from_device(bytes); }
    void reopen(Duration) override {}
    Wire& wire;
  };
  struct Delivery {
    bool to_device = false;
    std::string bytes;
    Origin origin;
    std::size_t command = 0;
  };

  void from_gateway(std::string_view bytes);
  void from_device(std::string_view bytes);
  void device_line(std::string text);
  void reopen(Duration wait);
  void deliver(const Delivery& delivery, TimePoint now);
  void to_gateway(std::string bytes, Origin origin, Duration extra);
  Scripted scripted(LineKind kind, const std::string& line) const { return script_ ? script_(kind, line) : Scripted{}; }
  bool strikes(double probability, const char* kind);
  std::string flipped(std::string text);

  Random& random_;
  Duration byte_time_;
  Faults faults_;
  Script script_;
  GatewayEnd gateway_end_{*this};
  DeviceEnd device_end_{*this};
  LineMachine* gateway_ = nullptr;
  LineMachine* device_ = nullptr;
  TimePoint now_{};
  bool open_ = false;
  std::function<bool()> device_answers_, device_reads_;
  std::optional<TimePoint> opens_at_;
  TimePoint to_device_free_{}, to_gateway_free_{};
  std::multimap<TimePoint, Delivery> in_transit_;
  std::multimap<TimePoint, std::string> held_notices_;  // that the device is slow to send
  std::vector<std::string> commands_;
  std::deque<std::size_t> unanswered_;  // commands that reached the device and await its reply
  std::optional<std::size_t> last_answered_;
  std::string device_partial_;
  std::optional<Origin> delivering_;
  std::deque<std::string> log_;
  std::uint64_t drawn_ = 0;
  std::set<std::uint64_t> spared_;
  std::function<Phase()> phase_;
  std::map<std::string, ByPhase> by_kind_;
};

}  // namespace axisgate::simulation
