// The line between the gateway and the simulated controller, in virtual time, with faults. Every line of the device
// carries the number of the command that it answers, which only the checks see.
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
#include "tests/simulation/digest.h"
#include "tests/simulation/random.h"

namespace axisgate::simulation {

// Probability of each fault per line, and the rate of mishaps of device and link per hour. All zero: a perfect line.
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
  double flood_notice = 0;  // notice: one number many times
  double flip_notice = 0;
  double reorder_notice = 0;  // notice: overtakes the previous notice
  // line; commands, replies and notices alike
  double lose_byte = 0;
  double double_byte = 0;
  double eight_bit = 0;        // one byte becomes a NUL or gets its top bit
  double merge = 0;            // the end of a line is lost, so that the next one continues it
  double mishaps_an_hour = 0;  // device and link: mishaps.h

  static Faults none() { return {}; }
  static Faults mild();
  static Faults rough();
  static Faults hostile();
  // Returns "quiet", "mild", "rough" or "hostile"; nullopt if there is no such profile.
  static std::optional<Faults> named(std::string_view profile);
};

// Phase of the run when a fault struck.
enum class Phase { idle, set, acknowledged, started, moving, completing, barrier, path };
inline constexpr std::array<std::string_view, 8> kPhaseNames = {"idle",   "set",        "acknowledged", "started",
                                                                "moving", "completing", "barrier",      "path"};
inline std::string_view name(Phase phase) { return kPhaseNames[static_cast<std::size_t>(phase)]; }

struct Origin {
  enum class Kind { reply, notice, noise } kind = Kind::reply;
  std::size_t command = 0;  // of a reply: the index of the command line that it answers
  bool damaged = false;     // differs from the line that was sent
};

// A fault of one chosen line, instead of a random one.
struct Scripted {
  bool drop = false;
  Duration delay{};                    // of this line and the lines after it; a notice waits alone
  std::optional<std::string> instead;  // these bytes, including the terminator
};
enum class LineKind { command, reply, notice };
using Script = std::function<Scripted(LineKind, const std::string& line)>;

bool sets_motion(std::string_view command);
bool starts_motion(std::string_view command);

class Wire {
 public:
  Wire(Random& random, std::uint64_t seed, int baud)
      : random_(random),
        damage_random_(seed ^ 0x44414D4147452121u),
        byte_time_(std::chrono::nanoseconds(10'000'000'000 / baud)) {}

  void set_faults(const Faults& faults) { faults_ = faults; }
  // Called for every line, before the faults are drawn.
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
  void cut(TimePoint now, Duration until_back);  // unplugs the cable
  // Kills the daemon: another daemon opens the line after `until_back`, and nobody reads until then. Bytes that were
  // written and have not passed yet are still sent, or lost with the old daemon.
  void change_gateway(LineMachine& gateway, TimePoint now, Duration until_back, bool written_is_lost);
  // Blocks one direction for `time`, even the rest of a line.
  void hold_up(bool to_device, Duration time);

  // Delivers the bytes of the present line that have arrived by `now`. Call before something happens in the middle of a
  // line.
  void pass_bytes(TimePoint now);
  // Calls `alarm` with the time at which the `count`th byte from now passes in either direction, as soon as that time
  // is known. With `of_set_and_go`, counts from the next line that sets a motion.
  void after_bytes(std::uint64_t count, bool of_set_and_go, std::function<void(TimePoint)> alarm);

  // Lines that the gateway wrote, oldest first. delivering() is the origin of a line during its delivery; nullopt
  // otherwise.
  const std::vector<std::string>& commands() const { return commands_; }
  // Reports whether the device has answered the newest command; the reply may still be in flight.
  bool answered() const { return last_answered_ && *last_answered_ + 1 == commands_.size(); }
  // `answers` reports whether the device's present output answers a command, `reads` whether the device reads at all,
  // which it does not during a restart.
  void set_device(std::function<bool()> answers, std::function<bool()> reads) {
    device_answers_ = std::move(answers);
    device_reads_ = std::move(reads);
  }
  void device_restarts() {
    unanswered_.clear();
    device_mid_line_ = false;
  }
  const std::optional<Origin>& delivering() const { return delivering_; }
  const std::deque<std::string>& log() const { return log_; }
  Digest& digest() { return digest_; }
  void note(TimePoint now, const std::string& text);

  // Suppresses faults by number. Faults count from 0 in the order in which they would strike.
  void spare(std::set<std::uint64_t> faults) { spared_ = std::move(faults); }
  void set_phase(std::function<Phase()> phase) { phase_ = std::move(phase); }
  // Counts and notes a fault that another class injects. Returns false if the fault is suppressed.
  bool inject(const char* kind);
  std::uint64_t faults_drawn() const { return drawn_; }
  // Number of commands changed into others on the line, and whether any line in either direction was changed since
  // `then`.
  int commands_damaged() const { return commands_damaged_; }
  bool damaged_since(TimePoint then) const { return last_damage_ && *last_damage_ >= then; }
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
    bool damaged = false;
  };

  void from_gateway(std::string_view bytes);
  void from_device(std::string_view bytes);
  void device_line(std::string text);
  void notice_line(std::string text, Duration extra);
  void make_noise();
  void reopen(Duration wait);
  void expect_answers(const Delivery& delivery);
  void deliver(const Delivery& delivery, TimePoint now);
  void to_gateway(std::string bytes, Origin origin, Duration extra);
  void transit(TimePoint at, Delivery delivery);
  Scripted scripted(LineKind kind, const std::string& line) const { return script_ ? script_(kind, line) : Scripted{}; }
  bool strikes(double probability, const char* kind);
  bool strikes_newly(double probability, const char* kind);
  std::string flipped(std::string text, Random& random);
  std::string with_bytes_damaged(std::string text);
  std::string_view end_of_line();

  Random& random_;
  Random damage_random_;  // a separate sequence, so that draws from before these faults stay the same
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
  std::multimap<TimePoint, Delivery> held_notices_;  // notices that the device sends late
  std::uint64_t alarm_bytes_ = 0;
  bool alarm_awaits_set_ = false;
  std::function<void(TimePoint)> alarm_;
  std::vector<std::string> commands_;
  std::deque<std::size_t> unanswered_;  // commands that reached the device and await its reply
  bool device_mid_line_ = false;
  std::optional<std::size_t> last_answered_;
  std::string device_partial_;
  std::optional<Origin> delivering_;
  std::deque<std::string> log_;
  Digest digest_;
  bool damaging_ = false;        // the line being sent is damaged
  bool unended_damage_ = false;  // the next line to the gateway continues a damaged one
  int commands_damaged_ = 0;
  std::optional<TimePoint> last_damage_;
  std::uint64_t drawn_ = 0;
  std::set<std::uint64_t> spared_;
  std::function<Phase()> phase_;
  std::map<std::string, ByPhase> by_kind_;
};

}  // namespace axisgate::simulation
