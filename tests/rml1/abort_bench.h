// Test bench of a sender and the simulated mill with a line and a converter between them, in virtual time. It shows
// how much still runs after an abort, and in which state the mill is left.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "device/rml1/sending/sender.h"
#include "tests/rml1/sender_line.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1 {

// A line with a converter. Bytes that leave the host are in the converter at once, and reach the mill at the speed of
// the line.
class LineToMill : public FlowLink {
 public:
  struct Setup {
    bool shows_cts = false;
    std::size_t converter = 0;  // bytes
    std::size_t late = 0;       // bytes that still leave after the mill has stopped the line
    bool can_ignore = true;     // flow control can be ignored
    int baud = 9600;
  };

  // `mill` must outlive this object.
  LineToMill(simulator::MillBench& mill, Setup setup);

  void write(std::string_view bytes) override;
  void reopen(Duration) override {}
  std::size_t unsent() const override;
  bool held() const override { return setup_.shows_cts && stopped(); }
  void ignore_flow_control(bool ignored) override { ignores_ = ignored && setup_.can_ignore; }

  // Returns the time at which the byte in flight reaches the mill.
  std::optional<TimePoint> next() const { return byte_ ? std::optional(arrives_) : std::nullopt; }
  // Begins the next byte, if it may leave.
  void pump(TimePoint now);
  char take();  // the byte that has arrived

  // Breaks the line: the host's bytes are lost, and also those of the converter if `converter_too`. Returns the number
  // of bytes that still arrive.
  std::size_t drop(bool converter_too);

  std::string written;  // all bytes written to the line

 protected:
  virtual bool stopped() const;  // by the mill, as the host sees it

  simulator::MillBench& mill_;

 private:
  bool may_leave();

  Setup setup_;
  std::deque<char> host_, converter_;
  std::optional<char> byte_;
  TimePoint arrives_{};
  std::size_t late_left_ = 0;
  bool ignores_ = false;
};

class AbortBench {
 public:
  // Starts the job. `job` and `timeline` must outlive this object. The mill has the test_profile() and begins at the
  // top above the work origin.
  AbortBench(std::string_view job, const Timeline& timeline, simulator::MillSetup mill, jobs::SendSettings settings,
             LineToMill::Setup line, std::string_view before = {});

  void run_for(Duration time);
  void finish();  // until nothing more happens without a command
  void press_view();

  // Aborts the job. Bytes of the job that are executed from here on count as run on.
  void abort();
  void stop_writing();

  Sender& sender() { return sender_; }
  const std::string& written() const { return line_.written; }
  simulator::Simulator::State state() { return mill_.mill.state(mill_.now); }

  std::size_t ran_on() const { return job_begun_ - executed_at_end_; }  // bytes of the job
  // Bytes of the job when writing ended: executed by the mill, and certain according to the sender.
  std::size_t executed_at_end() const { return executed_at_end_; }
  std::size_t certain_at_end() const { return certain_at_end_; }
  bool abort_lost() const { return abort_lost_; }  // a byte of the abort was lost, with error 16
  bool raise_started_spindle() const { return raise_started_spindle_; }

 private:
  void end_writing();
  std::optional<TimePoint> next() const;
  bool step(TimePoint until);
  void read_record();
  void begun(std::size_t buffered);
  bool delivers_job() const { return !job_written_ || delivered_ <= *job_written_; }

  const Profile profile_ = test_profile();
  simulator::MillBench mill_;
  LineToMill line_;
  SenderLine beside_;
  Sender sender_;
  std::size_t lines_read_ = 0;                    // lines of the record
  std::size_t delivered_ = 0;                     // bytes delivered to the mill
  std::size_t lost_ = 0, job_lost_ = 0;           // delivered bytes lost because the mill's buffer was full
  std::size_t begun_before_ = 0, job_begun_ = 0;  // bytes of the job up to the last but one command, and up to the last
  std::size_t executed_at_end_ = 0;               // bytes of the job when writing ended
  std::size_t certain_at_end_ = 0;
  std::optional<std::size_t> job_written_;  // bytes of the job when writing ended
  bool abort_begun_ = false, abort_lost_ = false, raise_started_spindle_ = false;
};

}  // namespace axisgate::rml1
