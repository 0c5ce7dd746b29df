#include "server/spool/upload.h"

#include <unistd.h>

#include <cstdint>
#include <utility>

#include "server/access/synced_file.h"

namespace axisgate::server::spool {

Upload::Upload(const Folder& folder, std::string path, Descriptor file, Job job, std::unique_ptr<Place> place,
               Keep keep)
    : folder_(folder),
      path_(std::move(path)),
      file_(std::move(file)),
      job_(std::move(job)),
      place_(std::move(place)),
      keep_(std::move(keep)) {}

Upload::~Upload() {
  // A file that cannot be removed now is removed at the next start.
  if (!kept_) folder_.remove_upload(path_);
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
  if (!write_all(file_.get(), bytes)) return cannot_write(path_);
  digest_.add(bytes);
  job_.bytes += size;
  return {};
}

Result<void> Upload::read_back(const std::function<void(std::string_view)>& take) {
  if (refusal_) return tl::unexpected(*refusal_);
  if (::lseek(file_.get(), 0, SEEK_SET) != 0) return cannot_write(path_);
  return read_pieces(file_.get(), path_, take);
}

Result<Job> Upload::finish() {
  if (refusal_) return tl::unexpected(*refusal_);
  if (const Result<void> synced = sync_and_close(); !synced) return tl::unexpected(synced.error());
  job_.sha256 = digest_.hexadecimal();
  Result<Job> kept = keep_(job_, path_, std::move(place_));
  kept_ = kept.has_value();
  return kept;
}

Result<void> Upload::sync_and_close() {
  if (::fsync(file_.get()) != 0 || ::close(file_.release()) != 0) return cannot_write(path_);
  return {};
}

}  // namespace axisgate::server::spool
