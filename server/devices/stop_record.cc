#include "server/devices/stop_record.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/events/wall_time.h"

namespace axisgate::server {
namespace {

using Json = nlohmann::json;
using stage::Stop;
using std::chrono::microseconds;

constexpr std::size_t kCallerMax = 160;
constexpr int kFormat = 1;

// Writes calendar time, because the monotonic clock begins again when the machine boots.
std::int64_t to_file(TimePoint time) {
  return std::chrono::duration_cast<microseconds>(to_wall(time).time_since_epoch()).count();
}
TimePoint from_file(std::int64_t time) { return to_monotonic(WallTime(microseconds(time))); }

Json to_json(const Stop& stop) {
  Json callers = Json::array();
  for (const std::string& who : stop.callers) callers.push_back(who.substr(0, kCallerMax));
  return {{"id", stop.id},
          {"emergency", stop.kind == stage::StopKind::emergency},
          {"axes", stop.axes.list()},
          {"written", stop.state == stage::StopState::written},
          {"callers", std::move(callers)},
          {"serial_number", stop.serial_number},
          {"asked", to_file(stop.asked)}};
}

Stop stop_in(const Json& json) {
  Stop stop;
  stop.id = json.at("id");
  stop.kind = json.at("emergency") ? stage::StopKind::emergency : stage::StopKind::stop;
  for (const int axis : json.at("axes").get<std::vector<int>>()) {
    if (axis >= 1 && axis <= stage::kAxesMax) stop.axes.add(axis);
  }
  stop.state = json.at("written") ? stage::StopState::written : stage::StopState::asked;
  stop.callers = json.at("callers").get<std::vector<std::string>>();
  stop.serial_number = json.at("serial_number");
  stop.asked = from_file(json.at("asked"));
  stop.late = true;  // the previous run may have ended before it answered the caller
  return stop;
}

// Returns an empty Inheritance if this class did not write the text.
stage::Inheritance parsed(std::string_view text) {
  stage::Inheritance left;
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat) return {};
    left.last_stop = json.at("last");
    for (const Json& stop : json.at("open")) left.open_stops.push_back(stop_in(stop));
    if (const Json& latch = json.at("latch"); !latch.is_null()) {
      left.emergency = stage::EmergencyLatch{latch.at("who"), from_file(latch.at("at"))};
    }
  } catch (const Json::exception&) {
    return {};
  }
  return left;
}

}  // namespace

Result<std::unique_ptr<StopRecord>> StopRecord::open(const std::string& path) {
  auto file = MappedText::open(path);
  if (!file) {
    file.error().hint = "a stop that is open when the daemon ends will be lost";
    return tl::unexpected(file.error());
  }
  return std::unique_ptr<StopRecord>(new StopRecord(*std::move(file)));
}

StopRecord::StopRecord(std::unique_ptr<MappedText> file) : file_(std::move(file)), before_(parsed(file_->text())) {
  last_ = before_.last_stop;
  latch_ = before_.emergency;
  for (const Stop& stop : before_.open_stops) open_[stop.id] = stop;
  syncing_ = std::thread([this] { sync_changes(); });
}

StopRecord::~StopRecord() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  syncing_.join();
}

void StopRecord::on_event(const stage::Event& event) {
  std::visit([this](const auto& what) { note(what); }, event);
}

void StopRecord::note(const stage::StopChanged& change) {
  last_ = std::max(last_, change.stop.id);
  if (is_open(change.stop.state)) {
    open_[change.stop.id] = change.stop;
  } else {
    open_.erase(change.stop.id);
  }
  write();
}

void StopRecord::note(const stage::EmergencyLatchChanged& change) {
  latch_ = change.latch;
  write();
}

void StopRecord::write() {
  Json open = Json::array();
  for (const auto& [id, stop] : open_) open.push_back(to_json(stop));
  Json latch;
  if (latch_) latch = {{"who", latch_->who.substr(0, kCallerMax)}, {"at", to_file(latch_->at)}};
  const Json json{{"format", kFormat}, {"last", last_}, {"open", std::move(open)}, {"latch", std::move(latch)}};
  file_->replace(json.dump(-1, ' ', true, Json::error_handler_t::replace));
  {
    const std::lock_guard lock(mutex_);
    unsynced_ = true;
  }
  changed_.notify_one();
}

void StopRecord::sync_changes() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return unsynced_ || ending_; });
    if (!std::exchange(unsynced_, false)) return;
    lock.unlock();
    file_->sync();
    lock.lock();
  }
}

}  // namespace axisgate::server
