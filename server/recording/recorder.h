// The recording of one device's line: made on the device's strand, read by other threads.
#pragma once

#include <prometheus/counter.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "device/stage/recording/recorder.h"
#include "server/recording/recording_ring.h"

namespace axisgate::server {

// Returns the header of a recording that begins now.
stage::RecordingHeader beginning_now(stage::RecordingHeader header);
stage::RecordingHeader recording_header(const stage::Profile& profile, std::string_view kind);

class DeviceRecorder {
 public:
  // `drops` counts the lines that readers lost, on the reader's thread. It must outlive this object.
  DeviceRecorder(const stage::RecordingHeader& header, Executor readers, prometheus::Counter& drops,
                 std::size_t bytes_kept = RecordingRing::kBytesKept);

  // Must be called on the device's strand.
  void on_event(const stage::Event& event, TimePoint now) { recorder_.on_event(event, now); }
  // Ends the current line, so that readers see it.
  void flush() { recorder_.flush(); }
  // Calls flush() and returns the beginning of a recording of later lines only.
  RecordingRing::Beginning begin();

  // The other functions are thread safe.

  const RecordingRing& ring() const { return ring_; }
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake) {
    return ring_.subscribe(std::move(wake));
  }

  // A Reader is the position of one reader in the recording. Not thread safe; the recorder must outlive it.
  class Reader {
   public:
    Reader(DeviceRecorder& recorder, RecordingRing::Position from) : recorder_(&recorder), position_(from) {}

    // Returns the next lines, each with its \n; empty if there are none yet. If the reader was too slow and lines are
    // no longer kept, a remark about the loss and a new header replace them, and they are counted.
    std::string next();

    const RecordingRing::Position& position() const { return position_; }

   private:
    DeviceRecorder* recorder_;
    RecordingRing::Position position_;
  };

 private:
  prometheus::Counter& drops_;
  RecordingRing ring_;
  stage::Recorder recorder_;
};

}  // namespace axisgate::server
