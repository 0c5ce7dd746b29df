// Owner of everything below gRPC: devices, their lines, the event bus, metrics and the threads.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "device/core/time.h"
#include "device/link/asio.h"
#include "device/link/line_thread.h"
#include "server/access/leases.h"
#include "server/config/config.h"
#include "server/devices/device.h"
#include "server/devices/stage.h"
#include "server/events/event_bus.h"
#include "server/events/timeouts.h"
#include "server/journal/journal.h"
#include "server/journal/request_memory.h"
#include "server/metrics/metrics.h"
#include "server/spool/spool.h"

namespace axisgate::server {

class RecordingFile;

// The gateway has two threads: one drives all lines, with a strand for each device; the other wakes the readers of
// streams, so that even a thousand readers do not delay the lines. All members are thread safe once start() has
// returned.
class Gateway {
 public:
  // `generation` grows with every start of the daemon (access/generation.h). `state_directory` keeps records for the
  // next run; empty: no records. `journal` and `spool` must outlive this object. A null journal means `kept = false`.
  // With a null spool, mills of the configuration are left out.
  Gateway(const Config& config, std::uint32_t generation, const std::string& state_directory = {},
          journal::Journal* journal = nullptr, spool::Spool* spool = nullptr);
  // Ends the threads. Unanswered requests stay unanswered, so their callers must have gone before.
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  void start();

  // Winds all devices down at the same time, then calls `done` on the lines' thread. Call it once.
  void wind_down(std::function<void()> done);
  // Time after which wind_down() is complete, unless a line's driver blocks.
  Duration wind_down_limit() const;

  // Random text, different for every start of the daemon. Without a journal, revisions and motions then start again
  // from 1.
  const std::string& run() const { return run_; }

  const Config& config() const { return config_; }
  const LeaseTokens& lease_tokens() const { return lease_tokens_; }
  EventBus& events() { return events_; }
  journal::Journal* journal() const { return journal_; }  // null with `kept = false`
  journal::RequestMemory& requests() { return requests_; }
  Metrics& metrics() { return metrics_; }
  const std::vector<std::unique_ptr<Device>>& devices() const { return devices_; }
  // The devices that are stages.
  const std::vector<Stage*>& stages() const { return stages_; }
  Stage* find_stage(std::string_view name) const;  // null if there is none

  // Tasks of these time limits run on the readers' thread.
  Timeouts& timeouts() { return timeouts_; }

 private:
  void add_stage(const DeviceConfig& device, const StageConfig& stage, const std::string& state_directory);
  void add_mill(const DeviceConfig& device, const MillConfig& mill, const std::string& state_directory,
                spool::Spool& spool);

  using Work = boost::asio::executor_work_guard<boost::asio::io_context::executor_type>;

  const Config config_;
  const std::string run_;
  journal::Journal* const journal_;
  journal::RequestMemory requests_;
  LineThread lines_;
  boost::asio::io_context readers_{1};
  Work readers_work_{readers_.get_executor()};
  Timeouts timeouts_{readers_};
  LeaseTokens lease_tokens_;
  Metrics metrics_;
  EventBus events_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<Stage*> stages_;  // from devices_
  std::vector<std::unique_ptr<RecordingFile>> recording_files_;
  std::thread readers_thread_;
};

}  // namespace axisgate::server
