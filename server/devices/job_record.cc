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
constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();

}  // namespace

// A process that is killed leaves each number whole.
struct JobRecord::Content {
  std::array<char, 16> mark;
  std::array<char, 48> boot;
  std::atomic<std::uint64_t> job, state, through, part, from, abort_waits;
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
  const bool same_boot =
      !boot.empty() && std::string_view(content->boot.data(), ::strnlen(content->boot.data(), 48)) == boot;
  const std::uint64_t state = content->state;
  if (known && content->job != 0 && state <= static_cast<std::uint64_t>(rml1::JobState::paused)) {
    before_ = LastJob{content->job, static_cast<rml1::JobState>(state), same_boot ? content->through.load() : kAll,
                      content->part, content->from};
  }
  abort_waited_ = known && content->abort_waits != 0;
  if (!known) content->job = 0;
  if (!same_boot) content->through = kAll;  // also for the run after this one
  content->mark = kMark;
  content->boot.fill(0);
  std::ranges::copy(boot.substr(0, 47), content->boot.begin());
}

JobRecord::~JobRecord() { ::munmap(content_, sizeof(Content)); }

void JobRecord::begin(const rml1::Job& job) {
  content_->job = 0;
  content_->through = next_byte(job);
  content_->part = job.part;
  content_->from = next_byte(job);
  content_->state = static_cast<std::uint64_t>(rml1::JobState::running);
  content_->job = job.number;
}

void JobRecord::going_to(std::uint64_t through) { content_->through = through; }

// Part and place come first: killed between, the daemon leaves a part that may have begun, not one that runs again.
void JobRecord::set_state(const rml1::Job& job) {
  if (content_->job != job.number) return;
  content_->part = job.part;
  content_->from = next_byte(job);
  content_->state = static_cast<std::uint64_t>(job.state);
}

void JobRecord::set_abort_waits(bool waits) { content_->abort_waits = waits ? 1 : 0; }

}  // namespace axisgate::server
