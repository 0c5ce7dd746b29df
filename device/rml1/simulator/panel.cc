// Actions of a person at the mill. The guideline mentions the panel, but hardly describes it.
#include "device/rml1/simulator/simulator.h"

namespace axisgate::rml1::simulator {

void Simulator::press_view(TimePoint now) {
  run_to(now);
  if (!power_) return;
  const bool pauses = !view_ && !not_ready_;
  // !NR "can only be canceled using the control panel" (guideline 3-3).
  view_ = pauses;
  not_ready_ = false;
  record_.panel(pauses ? "view" : "view released");
  if (pauses && setup_.options.is("view_data", "discarded")) discard_data("view");
  settle();
}

void Simulator::set_cover(bool open, TimePoint now) {
  run_to(now);
  if (open == cover_open_) return;
  cover_open_ = open;
  record_.panel(open ? "cover open" : "cover closed");
  if (open && power_ && setup_.options.is("cover_open", "ends")) {
    end_command();
    discard_data("cover");
  }
  settle();
}

void Simulator::press_stop(TimePoint now) {
  run_to(now);
  if (!power_) return;
  record_.panel("stop");
  end_command();
  spindle_.stop();
  discard_data("stop");
  view_ = not_ready_ = false;
  settle();
}

void Simulator::set_power(bool on, TimePoint now) {
  run_to(now);
  if (on == power_) return;
  power_ = on;
  record_.panel(on ? "power on" : "power off");
  if (on) {
    machine_.switch_on();
  } else {
    end_command();
    spindle_.switch_off();
    discard_data("power");
    device_control_.forget();
    display_.clear();
    view_ = not_ready_ = discarding_ = false;
    discarded_ = 0;
  }
  settle();
}

void Simulator::set_z1(double steps, TimePoint now) {
  advance(now);
  machine_.set_panel_z1(steps);
}

void Simulator::set_z2(double steps, TimePoint now) {
  advance(now);
  machine_.set_panel_z2(steps);
}

bool Simulator::set_origin(double x, double y, TimePoint now) {
  advance(now);
  return machine_.set_origin(x, y);
}

bool Simulator::set_z0(double machine_z, TimePoint now) {
  advance(now);
  return machine_.set_z0(machine_z);
}

std::string_view Simulator::pause_reason() const {
  if (cover_open_ && !setup_.options.is("cover_open", "ignored")) return "cover";
  if (not_ready_) return "not-ready";
  return view_ ? "view" : "no";
}

void Simulator::apply_pauses() {
  const std::string_view reason = pause_reason();
  if (!power_) return;
  if (reason == "no") {
    drive_.resume(now_);
  } else if (reason != "view" || setup_.options.is("view_takes_effect", "at-once") || drive_.idle()) {
    drive_.pause(now_);
  }
  drive_.run(now_);
}

Simulator::State Simulator::state(TimePoint now) {
  advance(now);
  return {.tool = machine_.workpiece(drive_.tool(now_)),
          .tool_down = machine_.tool_is_down(),
          .rpm = spindle_.rpm(),
          .buffered = buffer_.size(),
          .errors = display_.text(),
          .paused = pause_reason(),
          .moving = drive_.next().has_value(),
          .discarding = discarding_,
          .power = power_};
}

}  // namespace axisgate::rml1::simulator
