#include "server/devices/motion_record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "server/access/synced_file.h"

namespace axisgate::server {
namespace {

constexpr std::size_t kTextMax = 2048, kLinesKept = 2;
constexpr const char* kFirstLine = "axisgate motions 1";

stage::AxisSet axes_in(const std::string& text) {
  unsigned bits = 0;
  std::from_chars(text.data(), text.data() + text.size(), bits);
  stage::AxisSet axes;
  for (const int axis : stage::AxisSet::all().list()) {
    if ((bits >> axis & 1U) != 0) axes.add(axis);
  }
  return axes;
}

unsigned bits_of(stage::AxisSet axes) {
  unsigned bits = 0;
  for (const int axis : axes.list()) bits |= 1U << axis;
  return bits;
}

std::optional<stage::Unfinished> parsed(std::string_view text, std::string_view boot) {
  std::istringstream lines{std::string(text)};
  std::string line;
  if (!std::getline(lines, line) || line != kFirstLine) return std::nullopt;
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
    if (key == "sent") found.last_lines.push_back(value);
  }
  if (!whole || !same_boot || found.moving.empty()) return std::nullopt;
  return found;
}

std::string one_line(std::string_view text) {
  std::string clean(text);
  for (char& c : clean) {
    if (c < ' ' || c > '~') c = '?';
  }
  return clean;
}

}  // namespace

// Two texts, of which the first byte names the one that counts: a process that is killed while it writes the other
// leaves this one.
struct MotionRecord::File {
  struct Content {
    char counts;
    std::array<std::array<char, kTextMax>, 2> texts;
  };

  explicit File(Content* mapped) : content(mapped) {}
  ~File() { ::munmap(content, sizeof(Content)); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  std::size_t counting() const { return content->counts == '1' ? 1 : 0; }
  std::string_view text() const {
    const auto& bytes = content->texts[counting()];
    return {bytes.data(), ::strnlen(bytes.data(), bytes.size())};
  }
  void replace(const std::string& text) {
    const std::size_t other = 1 - counting();
    auto& bytes = content->texts[other];
    bytes.fill('\0');
    std::memcpy(bytes.data(), text.data(), std::min(text.size(), bytes.size()));
    std::atomic_thread_fence(std::memory_order_seq_cst);
    content->counts = other == 1 ? '1' : '0';
  }

  Content* const content;
};

Result<std::unique_ptr<MotionRecord>> MotionRecord::open(const std::string& path, std::string boot) {
  const Result<Descriptor> file = open_state_file(path, O_RDWR | O_CREAT);
  if (!file) return tl::unexpected(file.error());
  const auto failed = [&path](int error) {
    return fail(Reason::internal, fmt::format("cannot keep {}: {}", path, std::generic_category().message(error)),
                "a motion that runs when the daemon is killed will be taken for somebody else's");
  };
  if (!file->valid()) return failed(ENOENT);
  if (::ftruncate(file->get(), sizeof(File::Content)) != 0) return failed(errno);
  // All of it now: a write to a hole of a full disk would be a signal.
  if (const int error = ::posix_fallocate(file->get(), 0, sizeof(File::Content)); error != 0) return failed(error);
  void* const mapped = ::mmap(nullptr, sizeof(File::Content), PROT_READ | PROT_WRITE, MAP_SHARED, file->get(), 0);
  if (mapped == MAP_FAILED) return failed(errno);
  auto content = std::make_unique<File>(static_cast<File::Content*>(mapped));
  return std::unique_ptr<MotionRecord>(new MotionRecord(std::move(content), std::move(boot)));
}

MotionRecord::MotionRecord(std::unique_ptr<File> file, std::string boot)
    : file_(std::move(file)), boot_(std::move(boot)), unfinished_(parsed(file_->text(), boot_)) {}

MotionRecord::~MotionRecord() = default;

void MotionRecord::on_event(const stage::Event& event) {
  std::visit([this](const auto& what) { note(what); }, event);
}

void MotionRecord::note(const stage::MotionChanged& change) {
  const stage::Motion& motion = change.motion;
  started_ = started_ - motion.axes;
  if (stage::is_outcome(motion.state)) {
    motions_.erase(motion.id);
  } else {
    motions_.insert_or_assign(motion.id, motion);
  }
  write();
}

void MotionRecord::note(const stage::BytesWritten& bytes) {
  std::string line = bytes.bytes.substr(0, bytes.bytes.find_last_not_of("\r\n") + 1);
  last_lines_.push_front(std::move(line));
  if (last_lines_.size() > kLinesKept) last_lines_.pop_back();
  started_ = started_ | bytes.completes;
  if (!motions_.empty() || unfinished_) write();
}

void MotionRecord::note(const stage::LinkChanged& change) {
  if (change.link == stage::LinkState::up) serial_number_ = change.serial_number;
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
  for (const auto& [id, motion] : motions_) {
    const bool waits = motion.state == stage::MotionState::queued;
    const stage::AxisSet its = waits ? motion.axes & started_ : motion.axes;
    if (its.empty()) continue;
    moving = moving | its;
    if (motion.kind == stage::MotionKind::jog) jogged = jogged | its;
    names += fmt::format("{}motion {} ({}, asked by {})", names.empty() ? "" : ", ", id, stage::name(motion.kind),
                         one_line(motion.who));
  }
  std::string text = fmt::format("{}\nboot {}\nserial {}\nmoving {}\njogged {}\nmotions {}\n", kFirstLine, boot_,
                                 one_line(serial_number_.empty() ? left.serial_number : serial_number_),
                                 bits_of(moving), bits_of(jogged), names.substr(0, 512));
  for (const std::string& line : last_lines_) text += fmt::format("sent {}\n", one_line(line).substr(0, 256));
  return text + "end\n";
}

void MotionRecord::write() { file_->replace(text()); }

std::string boot_id() {
  std::string id;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
  return id;
}

}  // namespace axisgate::server
