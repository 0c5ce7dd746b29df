// The recording of one device's line: made on its strand, read at leisure.
#pragma once

#include <prometheus/counter.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "device/stage/recording/recorder.h"
#include "server/recording/recording_ring.h"

namespace axisgate::server {

// Of a recording that begins now.
stage::RecordingHeader beginning_now(stage::RecordingHeader header);
stage::RecordingHeader recording_header(const stage::Profile& profile);

class DeviceRecorder {
 public:
  // `drops` counts the lines that a reader lost, on its thread. It outlives this.
  DeviceRecorder(const stage::RecordingHeader& header, Executor readers, prometheus::Counter& drops,
                 std::size_t bytes_kept = RecordingRing::kBytesKept);

  // On the device's strand.
  void on_event(const stage::Event& event, TimePoint now) { recorder_.on_event(event, now); }
  // Finishes the line under way, so that readers see it.
  void flush() { recorder_.flush(); }
  // flush(), and where what is recorded from then on begins.
  RecordingRing::Beginning begin();

  // The rest from any thread.

  const RecordingRing& ring() const { return ring_; }
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake) {
    return ring_.subscribe(std::move(wake));
  }

  // One reader's way through the recording. Not thread safe by itself; the recorder outlives it.
  class Reader {
   public:
    Reader(DeviceRecorder& recorder, RecordingRing::Position from) : recorder_(&recorder), position_(from) {}

    // The next lines, each with its \n; empty: there are none yet. In the place of those that are no longer kept, as
    // the reader was too slow, stands a remark that says so, and a new header; they are counted.
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
