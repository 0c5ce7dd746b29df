#include "server/gateway.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <utility>

#include "device/core/explain.h"
#include "server/devices/after_crash.h"
#include "server/devices/mill.h"
#include "server/devices/motion_record.h"
#include "server/limits.h"
#include "server/log.h"
#include "server/recording/recording_file.h"

namespace axisgate::server {
namespace {

std::string random_run() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

Executor posting_to(boost::asio::io_context& context) {
  return [&context](std::function<void()> task) { boost::asio::post(context, std::move(task)); };
}

// Returns null and logs a warning if the record cannot be opened.
template <class Record>
std::unique_ptr<Record> kept(Result<std::unique_ptr<Record>> record) {
  if (record) return *std::move(record);
  log::warn("{}", explain(record.error()));
  return nullptr;
}

journal::RequestMemory memory_of(const JournalConfig& config, journal::Journal* journal, const std::string& run) {
  const journal::MemoryBounds bounds{std::chrono::hours(config.remember_hours),
                                     static_cast<std::size_t>(config.remember_requests)};
  if (journal == nullptr || !journal->is_open()) return {bounds, run, Duration::zero()};
  return {bounds, journal->epoch(), journal->boot_offset(), journal->take_requests()};
}

FactsBefore facts_before(journal::Journal* journal) {
  return journal == nullptr ? FactsBefore() : journal->take_facts();
}

// Empty without a journal.
EventBus::Keep keep_in(journal::Journal* journal) {
  if (journal == nullptr) return {};
  return [journal](FactPointer fact, std::uint64_t oldest) { journal->keep(std::move(fact), oldest); };
}

// Asio allocates descriptors with the first timer, and throws if none is free. This may fail at the daemon's start, but
// not later.
void open_timers(boost::asio::io_context& context) { const boost::asio::steady_timer first(context); }

}  // namespace

Gateway::Gateway(const Config& config, std::uint32_t generation, const std::string& state_directory,
                 journal::Journal* journal, spool::Spool* spool)
    : config_(config),
      run_(random_run()),
      journal_(journal),
      requests_(memory_of(config.journal, journal, run_)),
      lease_tokens_(generation),
      events_(posting_to(readers_), run_, facts_before(journal), keep_in(journal)) {
  open_timers(lines_.context());
  open_timers(readers_);
  const bool after_unclean_end = journal != nullptr && journal->after_unclean_end();
  events_.publish("", DaemonStarted{after_unclean_end}, std::chrono::system_clock::now());
  for (const DeviceConfig& device : config_.devices) {
    if (const auto* stage = std::get_if<StageConfig>(&device.family)) {
      add_stage(device, *stage, state_directory);
    } else if (spool != nullptr) {
      add_mill(device, std::get<MillConfig>(device.family), state_directory, *spool);
    }
  }
  settle_what_was_left(journal, requests_, events_, [this](std::string_view device) {
    const Stage* const stage = find_stage(device);
    return stage == nullptr ? std::nullopt : stage->started_before();
  });
}

void Gateway::add_stage(const DeviceConfig& device, const StageConfig& config, const std::string& state_directory) {
  const bool keeps = !state_directory.empty();
  auto motions =
      keeps ? kept(MotionRecord::open(fmt::format("{}/motions-{}", state_directory, device.name), boot_id())) : nullptr;
  auto stops = keeps ? kept(StopRecord::open(fmt::format("{}/stops-{}", state_directory, device.name))) : nullptr;
  auto stage = std::make_unique<Stage>(device, config, make_line(device, lines_.new_strand()), lines_, events_,
                                       metrics_, posting_to(readers_), lease_tokens_, std::move(motions),
                                       std::move(stops), journal_, requests_);
  stages_.push_back(stage.get());
  devices_.push_back(std::move(stage));
}

void Gateway::add_mill(const DeviceConfig& device, const MillConfig& config, const std::string& state_directory,
                       spool::Spool& spool) {
  auto record = kept(JobRecord::open(fmt::format("{}/job-{}", state_directory, device.name), boot_id()));
  devices_.push_back(std::make_unique<Mill>(device, config, config_.jobs, make_line(device, lines_.new_strand()),
                                            lines_, events_, metrics_, posting_to(readers_), lease_tokens_, spool,
                                            std::move(record), journal_));
}

Gateway::~Gateway() {
  if (journal_ != nullptr) journal_->answer_nobody();
  for (const auto& device : devices_) device->shutdown();
  readers_work_.reset();
  readers_.stop();
  // shutdown() has already sent the last commands of each line. The lines' timers end with their thread.
  lines_.stop();
  if (readers_thread_.joinable()) readers_thread_.join();
  for (const auto& device : devices_) device->recorder().flush();
  recording_files_.clear();
}

void Gateway::start() {
  lines_.start();
  readers_thread_ = std::thread([this] { readers_.run(); });
  for (const auto& device : devices_) {
    const DeviceConfig& config = *std::ranges::find(config_.devices, device->name(), &DeviceConfig::name);
    if (config.record.empty()) continue;
    const std::uint64_t bytes = static_cast<std::uint64_t>(config.record_megabytes) << 20;
    recording_files_.push_back(std::make_unique<RecordingFile>(config.record, device->recorder(), bytes));
  }
  for (const auto& device : devices_) device->start();
}

void Gateway::wind_down(std::function<void()> done) {
  const auto left = std::make_shared<std::atomic<std::size_t>>(devices_.size());
  for (const auto& device : devices_) {
    device->wind_down([left, done] {
      if (--*left == 0) done();
    });
  }
}

Duration Gateway::wind_down_limit() const {
  Duration longest{};
  for (const auto& device : devices_) longest = std::max(longest, device->wind_down_limit());
  return longest + kLastExchangeLimit;
}

Stage* Gateway::find_stage(std::string_view name) const {
  const auto found =
      std::ranges::find(stages_, name, [](const Stage* stage) { return std::string_view(stage->name()); });
  return found == stages_.end() ? nullptr : *found;
}

}  // namespace axisgate::server
