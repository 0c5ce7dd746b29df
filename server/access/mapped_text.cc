#include "server/access/mapped_text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "server/access/synced_file.h"

namespace axisgate::server {

// Two texts, and a first byte that names the valid one. A process that is killed while it writes the other text leaves
// the valid one complete.
struct MappedText::Content {
  char counts;
  std::array<std::array<char, kMax>, 2> texts;
};

Result<std::unique_ptr<MappedText>> MappedText::open(const std::string& path) {
  const Result<Descriptor> file = open_state_file(path, O_RDWR | O_CREAT);
  if (!file) return tl::unexpected(file.error());
  const auto failed = [&path](int error) {
    return fail(Reason::internal, fmt::format("cannot keep {}: {}", path, std::generic_category().message(error)));
  };
  if (!file->valid()) return failed(ENOENT);
  if (::ftruncate(file->get(), sizeof(Content)) != 0) return failed(errno);
  // Allocates the whole file now: writing to a hole on a full disk would raise SIGBUS.
  if (const int error = ::posix_fallocate(file->get(), 0, sizeof(Content)); error != 0) return failed(error);
  void* const mapped = ::mmap(nullptr, sizeof(Content), PROT_READ | PROT_WRITE, MAP_SHARED, file->get(), 0);
  if (mapped == MAP_FAILED) return failed(errno);
  return std::unique_ptr<MappedText>(new MappedText(static_cast<Content*>(mapped)));
}

MappedText::~MappedText() { ::munmap(content_, sizeof(Content)); }

std::size_t MappedText::counting() const { return content_->counts == '1' ? 1 : 0; }

std::string_view MappedText::text() const {
  const auto& bytes = content_->texts[counting()];
  return {bytes.data(), ::strnlen(bytes.data(), bytes.size())};
}

void MappedText::replace(const std::string& text) {
  const std::size_t other = 1 - counting();
  auto& bytes = content_->texts[other];
  bytes.fill('\0');
  std::memcpy(bytes.data(), text.data(), std::min(text.size(), bytes.size()));
  std::atomic_thread_fence(std::memory_order_seq_cst);
  content_->counts = other == 1 ? '1' : '0';
}

void MappedText::sync() const { ::msync(content_, sizeof(Content), MS_SYNC); }

}  // namespace axisgate::server
