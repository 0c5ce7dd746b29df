#include "server/devices/job_record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <system_error>

#include "server/access/synced_file.h"

namespace axisgate::server {
namespace {

constexpr std::array<char, 16> kMark = {'a', 'x', 'i', 's', 'g', 'a', 't', 'e', ' ', 'j', 'o', 'b', ' ', '1', '\n', 0};
constexpr std::size_t kNameSize = 104;  // longest name in the spool, and a terminating 0
constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kLostCounts = 1'000'000;  // more than can be sent between two boots

std::uint64_t bits_of(const jobs::Leaves& leaves) {
  return (leaves.surface ? 1u : 0u) | (leaves.revolutions ? 2u : 0u) | (leaves.rotation ? 4u : 0u) |
         (leaves.tool ? 8u : 0u);
}

jobs::Leaves leaves_of(std::uint64_t bits) {
  return {(bits & 1u) != 0, (bits & 2u) != 0, (bits & 4u) != 0, (bits & 8u) != 0};
}

template <std::size_t size>
std::string text_in(const std::array<char, size>& chars) {
  return {chars.data(), ::strnlen(chars.data(), size)};
}

// Cuts text that is too long. The last character stays 0.
template <std::size_t size>
void set_text(std::array<char, size>& chars, std::string_view text) {
  chars.fill(0);
  std::ranges::copy(text.substr(0, size - 1), chars.begin());
}

}  // namespace

// Layout of the file. Killing the process leaves each number whole.
struct JobRecord::Content {
  std::array<char, 16> mark;
  std::array<char, 48> boot;
  std::atomic<std::uint64_t> job, state, through, part, from, abort_waits, leaves;
  std::array<char, kNameSize> name;       // changes only while `job` is 0
  std::atomic<std::uint64_t> sent_least;  // 0 in the file of an older daemon: nothing is known to have been sent
  std::atomic<std::uint64_t> z0_count;
};

Result<std::unique_ptr<JobRecord>> JobRecord::open(const std::string& path, std::string_view boot) {
  const Result<Descriptor> file = open_state_file(path, O_RDWR | O_CREAT);
  if (!file) return tl::unexpected(file.error());
  void* mapped = MAP_FAILED;
  if (file->valid() && ::ftruncate(file->get(), sizeof(Content)) == 0) {
    mapped = ::mmap(nullptr, sizeof(Content), PROT_READ | PROT_WRITE, MAP_SHARED, file->get(), 0);
  }
  if (mapped == MAP_FAILED) {
    return fail(Reason::internal, fmt::format("{}: {}", path, std::generic_category().message(errno)),
                "after a killed daemon it is not known how far a job was sent");
  }
  return std::unique_ptr<JobRecord>(new JobRecord(static_cast<Content*>(mapped), boot));
}

JobRecord::JobRecord(Content* content, std::string_view boot) : content_(content) {
  const bool known = content->mark == kMark;
  const bool same_boot = !boot.empty() && text_in(content->boot) == boot;
  const std::uint64_t state = content->state;
  if (known && content->job != 0 && state < jobs::kJobStates) {
    before_ = LastJob{.job = content->job,
                      .state = static_cast<jobs::JobState>(state),
                      .through = same_boot ? content->through.load() : kAll,
                      .part = content->part,
                      .from = content->from,
                      .sent_least = content->sent_least,
                      .name = text_in(content->name),
                      .leaves = leaves_of(content->leaves)};
  }
  abort_waited_ = known && content->abort_waits != 0;
  if (!known) {
    content->job = 0;
    content->z0_count = 0;
  }
  if (!same_boot) {
    content->through = kAll;           // counts for the next run, too
    content->z0_count += kLostCounts;  // the last counts may not have reached the disk
  }
  content->mark = kMark;
  set_text(content->boot, boot);
}

JobRecord::~JobRecord() { ::munmap(content_, sizeof(Content)); }

void JobRecord::begin(const jobs::Job& job) {
  content_->job = 0;
  content_->through = next_byte(job);
  content_->part = job.part;
  content_->from = next_byte(job);
  content_->sent_least = next_byte(job);
  content_->state = static_cast<std::uint64_t>(jobs::JobState::running);
  content_->leaves = bits_of(job.leaves);
  set_text(content_->name, job.name);
  content_->job = job.number;
}

void JobRecord::going_to(const jobs::WrittenRange& sent) {
  content_->sent_least = std::max<std::uint64_t>(content_->sent_least, sent.least);
  content_->through = sent.most;
}

// Writes part and place first: if the daemon is killed in between, the part may have begun, but never runs again.
void JobRecord::set_state(const jobs::Job& job) {
  if (content_->job != job.number) return;
  content_->part = job.part;
  content_->from = next_byte(job);
  content_->sent_least = job.written ? job.written->least : next_byte(job);
  content_->state = static_cast<std::uint64_t>(job.state);
}

std::uint64_t JobRecord::z0_count() const { return content_->z0_count; }

void JobRecord::set_z0_count(std::uint64_t z0_count) { content_->z0_count = z0_count; }

void JobRecord::set_abort_waits(bool waits) { content_->abort_waits = waits ? 1 : 0; }

}  // namespace axisgate::server
