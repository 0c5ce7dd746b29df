// Report for a person who helps, without secrets.
#pragma once

#include <deque>
#include <string>

#include "server/api/looking/diagnostics.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"
#include "server/recording/redaction.h"

namespace axisgate::api {

class SupportReport final : public Subscription<std::string> {
 public:
  SupportReport(server::Gateway& gateway, const DoorReport& door, Streams::Place place);

 private:
  // A Recording is the recording of one device up to its newest line when the report was requested.
  struct Recording {
    std::string head;
    server::DeviceRecorder::Reader reader;
    server::RecordingRing::Position end;
  };

  void add_devices(server::Gateway& gateway, const DoorReport& door);
  void add_recordings(server::Gateway& gateway);
  static std::string next_of(Recording& recording);
  void begin() override { wake(); }
  Reading read() override;

  server::Redactor redactor_;
  std::string first_;  // everything except the recordings, which may be long
  std::deque<Recording> recordings_;
  bool summary_due_ = true;
};

}  // namespace axisgate::api
