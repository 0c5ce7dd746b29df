#include "server/devices/motion_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <utility>

namespace axisgate::server {
namespace {

// More different lines are never written between two answers.
constexpr std::size_t kLinesKept = 16;
// Their ends may not be in the journal yet. The number of motions without an outcome is never higher.
constexpr std::size_t kStartedKept = 16;
constexpr std::size_t kNamesMax = 512, kLineMax = 256, kNameMax = 160;
constexpr const char* kFirstLine = "axisgate motions 2";

stage::AxisSet axes_in(const std::string& text) {
  unsigned bits = 0;
  std::from_chars(text.data(), text.data() + text.size(), bits);
  stage::AxisSet axes;
  for (const int axis : stage::AxisSet::first(stage::kAxesMax).list()) {
    if ((bits >> axis & 1U) != 0) axes.add(axis);
  }
  return axes;
}

unsigned bits_of(stage::AxisSet axes) {
  unsigned bits = 0;
  for (const int axis : axes.list()) bits |= 1U << axis;
  return bits;
}

// Parses "STATE MOTION WHO REQUEST_ID", separated by tabs; neither name contains a tab.
std::optional<StartedMotion> started_in(const std::string& text) {
  std::istringstream words(text);
  std::string state, motion;
  StartedMotion request;
  const bool whole =
      std::getline(words, state, '\t') && std::getline(words, motion, '\t') && std::getline(words, request.who, '\t');
  std::getline(words, request.request_id);
  int number = 0;
  const auto [end, error] = std::from_chars(state.data(), state.data() + state.size(), number);
  std::from_chars(motion.data(), motion.data() + motion.size(), request.motion);
  if (!whole || error != std::errc{} || number < 0 || number > static_cast<int>(stage::MotionState::unknown)) return {};
  request.state = static_cast<stage::MotionState>(number);
  return request;
}

std::string one_line(std::string_view text) {
  std::string clean(text);
  for (char& c : clean) {
    if (c < ' ' || c > '~') c = '?';
  }
  return clean;
}

}  // namespace

struct MotionRecord::Left {
  std::optional<stage::Unfinished> unfinished;
  StartedMotions started;
  stage::MotionId last_motion = 0;
};

// Returns nullopt if the text is incomplete or from another boot.
std::optional<MotionRecord::Left> MotionRecord::parsed(std::string_view text, std::string_view boot) {
  std::istringstream lines{std::string(text)};
  std::string line;
  if (!std::getline(lines, line) || line != kFirstLine) return std::nullopt;
  Left left;
  stage::Unfinished found;
  bool same_boot = false, whole = false;
  while (std::getline(lines, line)) {
    const std::size_t space = line.find(' ');
    if (space == std::string::npos) {
      whole = line == "end";
      continue;
    }
    const std::string key = line.substr(0, space), value = line.substr(space + 1);
    if (key == "boot") same_boot = !value.empty() && value == boot;
    if (key == "serial") found.serial_number = value;
    if (key == "moving") found.moving = axes_in(value);
    if (key == "jogged") found.jogged = axes_in(value);
    if (key == "motions") found.motions = value;
    if (key == "last") std::from_chars(value.data(), value.data() + value.size(), left.last_motion);
    if (key == "dropped") {
      std::from_chars(value.data(), value.data() + value.size(), left.started.dropped_through);
    }
    if (key == "sent") found.last_lines.push_back(value);
    if (key != "started") continue;
    if (auto request = started_in(value)) left.started.kept.push_back(*std::move(request));
  }
  if (!whole || !same_boot) return std::nullopt;
  if (!found.moving.empty()) left.unfinished = std::move(found);
  return left;
}

Result<std::unique_ptr<MotionRecord>> MotionRecord::open(const std::string& path, std::string boot) {
  auto file = MappedText::open(path);
  if (!file) {
    file.error().hint = "a motion that runs when the daemon is killed will be reported as foreign motion";
    return tl::unexpected(file.error());
  }
  return std::unique_ptr<MotionRecord>(new MotionRecord(*std::move(file), std::move(boot)));
}

MotionRecord::MotionRecord(std::unique_ptr<MappedText> file, std::string boot)
    : file_(std::move(file)), boot_(std::move(boot)) {
  std::optional<Left> left = parsed(file_->text(), boot_);
  if (!left) return;
  unfinished_ = std::move(left->unfinished);
  // If this run is killed, their ends may still be missing in the journal.
  started_motions_ = left->started;
  started_before_ = std::move(left->started);
  last_motion_ = left->last_motion;
}

MotionRecord::~MotionRecord() = default;

void MotionRecord::on_event(const stage::Event& event) {
  std::visit([this](const auto& what) { note(what); }, event);
}

void MotionRecord::note(const stage::MotionChanged& change) {
  const stage::Motion& motion = change.motion;
  last_motion_ = std::max(last_motion_, motion.id);
  started_ = started_ - motion.axes;
  for (StartedMotion& request : started_motions_.kept) {
    if (request.motion == motion.id) request.state = motion.state;
  }
  if (stage::is_outcome(motion.state)) {
    motions_.erase(motion.id);
    // The axes were not seen to stop.
    if (motion.state == stage::MotionState::unknown && motion.written) left_moving_[motion.id] = motion;
  } else {
    motions_.insert_or_assign(motion.id, motion);
  }
  write();
}

void MotionRecord::note(const stage::BytesWritten& bytes) {
  std::string line = bytes.bytes.substr(0, bytes.bytes.find_last_not_of("\r\n") + 1);
  std::erase(last_lines_, line);
  last_lines_.push_front(std::move(line));
  if (last_lines_.size() > kLinesKept) last_lines_.pop_back();
  started_ = started_ | bytes.completes;
  if (bytes.motion != 0) note_started(bytes.motion);
  if (something_may_move()) write();
}

// The controller has received this line, so the lines before it no longer count. A line that was refused may not be
// remembered by the controller (manual 40) ?:CMD).
void MotionRecord::note(const stage::ExchangeEnded& ended) {
  using Outcome = stage::ExchangeEnded::Outcome;
  const bool taken = ended.outcome == Outcome::ok || ended.outcome == Outcome::ok_d || ended.outcome == Outcome::data;
  if (!taken || last_lines_.empty() || last_lines_.front() != ended.line) return;
  last_lines_.resize(1);
  if (something_may_move()) write();
}

bool MotionRecord::something_may_move() const { return !motions_.empty() || !left_moving_.empty() || unfinished_; }

void MotionRecord::note_started(stage::MotionId id) {
  const auto motion = motions_.find(id);
  auto& [kept, dropped_through] = started_motions_;
  const bool noted = std::ranges::any_of(kept, [id](const auto& request) { return request.motion == id; });
  if (noted || motion == motions_.end()) return;
  kept.push_back({id, motion->second.state, motion->second.who, motion->second.request_id});
  if (kept.size() <= kStartedKept) return;
  dropped_through = std::max(dropped_through, kept.front().motion);
  kept.erase(kept.begin());
}

void MotionRecord::note(const stage::LinkChanged& change) {
  if (change.link != stage::LinkState::up) return;
  serial_number_ = change.serial_number;
  // When the handshake ends, all axes are stationary.
  if (!std::exchange(left_moving_, {}).empty()) write();
}

void MotionRecord::note(const stage::UnfinishedJudged& judged) {
  using What = stage::UnfinishedJudged::What;
  if (judged.what != What::not_ours && judged.what != What::stationary) return;
  unfinished_.reset();
  write();
}

std::string MotionRecord::text() const {
  const stage::Unfinished left = unfinished_.value_or(stage::Unfinished{});
  stage::AxisSet moving = left.moving, jogged = left.jogged;
  std::string names = left.motions;
  auto motions = left_moving_;
  motions.insert(motions_.begin(), motions_.end());
  for (const auto& [id, motion] : motions) {
    const bool waits = motion.state == stage::MotionState::queued;
    const stage::AxisSet its = waits ? motion.axes & started_ : motion.axes;
    if (its.empty()) continue;
    moving = moving | its;
    if (motion.kind == stage::MotionKind::jog) jogged = jogged | its;
    names += fmt::format("{}motion {} ({}, asked by {})", names.empty() ? "" : ", ", id, stage::name(motion.kind),
                         one_line(motion.who));
  }
  std::string text = fmt::format("{}\nboot {}\nserial {}\nlast {}\nmoving {}\njogged {}\nmotions {}\n", kFirstLine,
                                 boot_, one_line(serial_number_.empty() ? left.serial_number : serial_number_),
                                 last_motion_, bits_of(moving), bits_of(jogged), names.substr(0, kNamesMax));
  for (const std::string& line : last_lines_) text += fmt::format("sent {}\n", one_line(line).substr(0, kLineMax));
  return text + started_lines() + "end\n";
}

std::string MotionRecord::started_lines() const {
  std::string lines = fmt::format("dropped {}\n", started_motions_.dropped_through);
  for (const StartedMotion& request : started_motions_.kept) {
    lines += fmt::format("started {}\t{}\t{}\t{}\n", static_cast<int>(request.state), request.motion,
                         one_line(request.who).substr(0, kNameMax), one_line(request.request_id).substr(0, kNameMax));
  }
  return lines;
}

void MotionRecord::write() { file_->replace(text()); }

std::string boot_id() {
  std::string id;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
  return id;
}

}  // namespace axisgate::server
