// A mill without its hardware. Its input is bytes, time and the actions of a person at its panel; its output is XON,
// XOFF and a record of its actions. It never answers (guideline 4-2, "Other device control commands are basically
// unsupported").
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "device/core/simulation.h"
#include "device/rml1/simulator/buffer.h"
#include "device/rml1/simulator/device_control.h"
#include "device/rml1/simulator/display.h"
#include "device/rml1/simulator/drive.h"
#include "device/rml1/simulator/machine.h"
#include "device/rml1/simulator/options.h"
#include "device/rml1/simulator/reader.h"
#include "device/rml1/simulator/record.h"
#include "device/rml1/simulator/spindle.h"

namespace axisgate::rml1::simulator {

// Time advances only by the given `now`. Everything that became due before `now` happens in order, each at its own
// time. Not thread safe.
class Simulator : public Simulation, private DeviceControlSink, private ReaderListener {
 public:
  // The line must outlive the simulator. `record` receives a line of JSON for everything that happens; it may be empty.
  Simulator(MillSetup setup, ByteLink& line, Record::Write record = {});
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  // A mill does not notice a change at the other end of its line.
  void link_up(TimePoint now) override { advance(now); }
  void link_down(TimePoint now, std::string_view) override { advance(now); }
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override { return drive_.next(); }
  // Carries out a line of the control language, without its end, at `now` in the mill's time. Returns the values that
  // the command reports, often none. A refused command changes nothing. Defined in control.cc.
  Result<std::string> operate(std::string_view line, TimePoint now) override;

  // Reports whether the host must not send: after XOFF, or while CTS is low.
  bool holds_back() const;

  // Actions at the panel
  void press_view(TimePoint now);
  void set_cover(bool open, TimePoint now);
  void press_stop(TimePoint now);
  void set_power(bool on, TimePoint now);
  void set_z1(double steps, TimePoint now);            // -8388608 to 0, above Z0
  void set_z2(double steps, TimePoint now);            // 0 to 8388607, above Z0
  bool set_origin(double x, double y, TimePoint now);  // steps from the home corner; false outside of the area
  bool set_z0(double machine_z, TimePoint now);        // a machine coordinate; false outside of Z's travel

  struct State {
    Machine::Point tool;  // steps, in workpiece coordinates
    bool tool_down = false;
    double rpm = 0;  // 0: the spindle is stopped
    std::size_t buffered = 0;
    std::string errors;       // errors on the display, or "none"
    std::string_view paused;  // "no", "cover", "not-ready" or "view"
    bool moving = false;
    bool discarding = false;  // until the next ESC.K
    bool power = true;
  };
  State state(TimePoint now);

 private:
  void data(char byte) override;
  void escape_k() override;
  void line_error(int number) override;
  void order(Order order) override { read_.emplace_back(std::move(order)); }
  void command_error(int number) override { read_.emplace_back(number); }

  PanelEvents panel_events();
  void run_to(TimePoint now);
  void settle();
  void interpret();
  void interpret(const Buffer::Item& item);
  void execute(const Order& order);
  void hold_back();
  void show_command_error(int number);
  void end_command();
  void discard_data(std::string_view by);
  void toggle_discarding();
  void apply_pauses();
  std::string_view pause_reason() const;

  MillSetup setup_;
  ByteLink& line_;
  TimePoint now_{};
  Record record_;
  Display display_;
  SpindleMotor spindle_;
  Drive drive_;
  Machine machine_;
  Reader reader_;
  DeviceControl device_control_;
  Buffer buffer_;
  Handshake handshake_;
  // Commands, and numbers of errors between them, that were read and not yet executed or shown.
  std::deque<std::variant<Order, int>> read_;
  bool power_ = true;
  bool view_ = false, cover_open_ = false, not_ready_ = false;
  bool discarding_ = false;
  std::size_t discarded_ = 0;  // bytes discarded since discarding_ was set
};

}  // namespace axisgate::rml1::simulator
