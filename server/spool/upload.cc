#include "server/spool/upload.h"

#include <unistd.h>

#include <cstdint>
#include <utility>

#include "server/access/synced_file.h"

namespace axisgate::server::spool {

Upload::Upload(const Folder& folder, Descriptor file, Job job, std::unique_ptr<Place> place, Keep keep)
    : folder_(folder), file_(std::move(file)), job_(std::move(job)), place_(std::move(place)), keep_(std::move(keep)) {}

Upload::~Upload() {
  // What cannot be removed now is removed at the next start.
  if (!kept_) folder_.remove(job_.id);
}

Result<void> Upload::append(std::string_view bytes) {
  if (refusal_) return tl::unexpected(*refusal_);
  Result<void> written = write(bytes);
  if (!written) refusal_ = written.error();
  return written;
}

Result<void> Upload::write(std::string_view bytes) {
  const auto size = static_cast<std::int64_t>(bytes.size());
  if (Result<void> grown = place_->grow(size); !grown) return grown;
  if (!write_all(file_.get(), bytes)) return cannot_write(folder_.bytes_path(job_.id));
  digest_.add(bytes);
  job_.bytes += size;
  return {};
}

Result<Job> Upload::finish() {
  if (refusal_) return tl::unexpected(*refusal_);
  if (const Result<void> synced = sync_and_close(); !synced) return tl::unexpected(synced.error());
  job_.sha256 = digest_.hexadecimal();
  if (const Result<void> kept = keep_(job_, std::move(place_)); !kept) return tl::unexpected(kept.error());
  kept_ = true;
  return job_;
}

Result<void> Upload::sync_and_close() {
  if (::fsync(file_.get()) != 0 || ::close(file_.release()) != 0) return cannot_write(folder_.bytes_path(job_.id));
  return {};
}

}  // namespace axisgate::server::spool
