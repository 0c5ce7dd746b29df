#include "device/rml1/simulator/simulator.h"

#include <utility>

namespace axisgate::rml1::simulator {
namespace {

constexpr int kBufferOverflow = 16;  // guideline 4-1, error list

}  // namespace

Simulator::Simulator(MillSetup setup, ByteLink& line, Record::Write record)
    : setup_(std::move(setup)),
      line_(line),
      record_(std::move(record)),
      spindle_(setup_.profile.spindle, record_),
      drive_(setup_, spindle_, record_),
      machine_(setup_, drive_, spindle_, panel_events()),
      reader_(setup_.profile.dialect, *this),
      device_control_(*this),
      buffer_(setup_.buffer_bytes),
      handshake_(setup_.flow) {}

PanelEvents Simulator::panel_events() {
  return {.error = [this](int number) { show_command_error(number); },
          .clear_command_errors = [this] { display_.clear_command_errors(); },
          .clear_errors = [this] { display_.clear(); },
          .pause = [this] { not_ready_ = true; }};
}

void Simulator::receive(std::string_view bytes, TimePoint now) {
  run_to(now);
  for (const char byte : bytes) {
    if (!power_) return;
    device_control_.take(byte);
    settle();
  }
}

void Simulator::advance(TimePoint now) {
  run_to(now);
  settle();
}

void Simulator::run_to(TimePoint now) {
  for (auto next = drive_.next(); next && *next <= now; next = drive_.next()) {
    now_ = *next;
    record_.at(now_);
    drive_.run(now_);
    settle();
  }
  now_ = now;
  record_.at(now_);
}

void Simulator::settle() {
  apply_pauses();
  interpret();
  hold_back();
}

// Executes one command after another; each begins when the previous one has been executed.
void Simulator::interpret() {
  while (power_ && drive_.idle()) {
    if (!read_.empty()) {
      const auto next = std::move(read_.front());
      read_.pop_front();
      if (const int* error = std::get_if<int>(&next)) {
        show_command_error(*error);
      } else {
        execute(std::get<Order>(next));
      }
    } else if (const auto item = buffer_.take()) {
      interpret(*item);
    } else {
      return;
    }
  }
}

void Simulator::execute(const Order& order) {
  record_.command(order, buffer_.size());
  machine_.execute(order);
  apply_pauses();
}

void Simulator::interpret(const Buffer::Item& item) {
  if (item.escape_k) {
    reader_.forget();
    toggle_discarding();
  } else if (discarding_) {
    ++discarded_;
  } else {
    reader_.take(item.byte);
  }
}

void Simulator::hold_back() {
  if (!power_) return;
  if (const auto byte = handshake_.update(buffer_)) line_.write({&*byte, 1});
}

bool Simulator::holds_back() const {
  if (!power_) return setup_.flow == Flow::rts;
  return handshake_.stopped();
}

void Simulator::data(char byte) {
  if (discarding_ && !setup_.options.is("escape_k", "in-band")) {
    ++discarded_;
  } else if (!buffer_.put(byte)) {
    line_error(kBufferOverflow);
  }
}

// Handles ESC.K, which "ends operation of the command now being executed and discards without executing it all buffered
// data until the next ESC.K" (guideline 4-2). README.md has the three interpretations.
void Simulator::escape_k() {
  if (setup_.options.is("escape_k", "in-band")) {
    if (!buffer_.put_escape_k()) line_error(kBufferOverflow);
    return;
  }
  if (buffer_.full() && setup_.options.is("escape_k_when_full", "dropped")) return line_error(kBufferOverflow);
  if (!discarding_) {
    end_command();
    discard_data("escape_k");
  }
  if (setup_.options.is("escape_k", "toggle")) toggle_discarding();
}

void Simulator::toggle_discarding() {
  discarding_ = !discarding_;
  if (!discarding_) record_.discarded("escape_k", std::exchange(discarded_, 0));
}

void Simulator::end_command() {
  drive_.end(now_);
  machine_.forget_target();
}

void Simulator::discard_data(std::string_view by) {
  record_.discarded(by, buffer_.size());
  buffer_.clear();
  read_.clear();
  reader_.forget();
}

void Simulator::line_error(int number) {
  display_.line_error(number);
  record_.error(number);
}

void Simulator::show_command_error(int number) {
  display_.command_error(number);
  record_.error(number);
}

}  // namespace axisgate::rml1::simulator
